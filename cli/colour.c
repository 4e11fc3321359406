#include "base/text/json_text.h"
#include "cli/command/arguments.h"
#include "cli/command/describe.h"
#include "registration/colour/calibration.h"

#include <stdlib.h>
#include <string.h>

typedef struct colour_command {
    weft_common_options common;
    const char *input, *output;
    int chart, model;
    bool linear;
} colour_command;

static const char *const model_words[] = {"chosen", "linear", "root", NULL};
static const int model_terms[] = {0, WEFT_COLOUR_LINEAR_TERMS, WEFT_COLOUR_ROOT_TERMS};

static const weft_option option_table[] = {
    {.argument = "CHART.jpg|SESSION",
     .is_required = true,
     .kind = WEFT_OPTION_INPUT,
     .offset = offsetof(colour_command, input)},
    {"output", 'o', "COLOUR.json", "The colour file to write", .is_required = true, .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(colour_command, output)},
    {"chart", .argument = "CHART",
     .help = "classic (default): ColorChecker Classic or Passport made since November 2014; classic-2005: made before; "
             "sg: ColorChecker Digital SG",
     .kind = WEFT_OPTION_CHOICE, .offset = offsetof(colour_command, chart), .words = weft_chart_word},
    {"model", .argument = "WHICH",
     .help =
         "linear: a matrix; root: a root polynomial; chosen (default): the one that predicts left-out patches better",
     .kind = WEFT_OPTION_CHOICE, .offset = offsetof(colour_command, model), .words = model_words},
    {"linear", .help = "8- and 16-bit files hold linear values, without a tone curve", .kind = WEFT_OPTION_FLAG,
     .offset = offsetof(colour_command, linear)},
    {0},
};

/* ---- Messages ---- */

static void say_patches(const weft_common_options *common, const weft_colour_report *report)
{
    for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
        const weft_colour_patch *patch = &report->patch[i];
        if (patch->unused)
            weft_command_say(common, "  %-14s not used: %s", patch->name, patch->unused);
        else
            weft_command_say(common, "  %-14s %5.2f  left out %5.2f", patch->name, patch->fitted, patch->left_out);
    }
}

static void say_colour(const colour_command *command, const weft_colour_report *report)
{
    const weft_common_options *common = &command->common;
    const weft_colour *colour = &report->colour;
    weft_command_say(
        common, "%s: a %s, from %d of %d patches; colours differ from the chart's, in CIEDE2000, by:", command->output,
        colour->terms == WEFT_COLOUR_ROOT_TERMS ? "root polynomial" : "matrix", report->used, WEFT_CHART_PATCHES);
    say_patches(common, report);
    weft_command_say(common, "a patch that the matrix was not fitted to: %.2f in the mean, %.2f at worst",
                     colour->left_out.mean, colour->left_out.worst);
    weft_command_say(common, "the patches that it was fitted to: %.2f in the mean, %.2f at worst", colour->fitted.mean,
                     colour->fitted.worst);
    weft_command_say(common, "the lamp lights one corner of the chart %.2f times as much as another",
                     report->lamp_range);
    weft_command_say_lines(common, "warning: ", &report->warnings);
}

/* ---- The file ---- */

static json_t *pack_patch(const weft_colour_patch *p)
{
    json_t *packed = json_pack("{ss s[ff] s[fff] s[fff] s[fff]}", "patch", p->name, "pixel", p->pixel[0], p->pixel[1],
                               "camera", p->camera[0], p->camera[1], p->camera[2], "srgb", p->srgb[0], p->srgb[1],
                               p->srgb[2], "reference", p->reference[0], p->reference[1], p->reference[2]);
    if (p->unused) {
        weft_json_put(&packed, "unused", json_string(p->unused));
        return packed;
    }
    weft_json_put(&packed, "fitted", json_real(p->fitted));
    weft_json_put(&packed, "left_out", json_real(p->left_out));
    return packed;
}

/* What stands in the file and in the event beside the colour itself. */
static json_t *pack_record(const colour_command *command, const weft_colour_report *report)
{
    json_t *patches = json_array();
    for (int i = 0; i < WEFT_CHART_PATCHES; i++)
        weft_json_append(&patches, pack_patch(&report->patch[i]));
    return json_pack("{so ss sf so}", "photograph", weft_json_text(command->input, strlen(command->input)), "chart",
                     weft_chart_word[command->chart], "lamp_range", report->lamp_range, "patches", patches);
}

static weft_code show_event(const colour_command *command, const weft_colour_report *report, json_t *record,
                            weft_error *error)
{
    json_t *event = json_pack("{si}", "used", report->used);
    json_t *packed = weft_colour_pack(&report->colour);
    bool is_complete = packed && json_object_update(event, packed) == 0 && json_object_update(event, record) == 0;
    json_decref(packed);
    if (!is_complete) {
        json_decref(event);
        event = NULL;
    }
    return weft_command_report(&command->common, "colour", event, error);
}

static weft_code keep(const colour_command *command, const weft_colour_report *report, weft_error *error)
{
    json_t *record = pack_record(command, report);
    if (!record)
        return weft_fail_memory(error, command->output, 0);
    weft_code code = weft_colour_write(command->output, &report->colour, record, error);
    if (code == WEFT_OK) {
        say_colour(command, report);
        code = show_event(command, report, record, error);
    }
    json_decref(record);
    return code;
}

static int run(int argc, char **argv)
{
    colour_command command = {0};
    weft_error error = {0};
    weft_colour_report report;
    weft_arguments_parse(&weft_command_colour, argc, argv, &command);
    const weft_colour_settings settings = {(weft_chart_kind)command.chart, model_terms[command.model], command.linear};
    weft_code code = weft_colour_calibrate(command.input, &settings, &report, &error);
    if (code == WEFT_OK)
        code = keep(&command, &report, &error);
    weft_colour_report_free(&report);
    return weft_command_exit("colour", &command.common, code, &error);
}

const weft_command weft_command_colour = {
    .name = "colour",
    .summary = "calibrate the colours of a camera from a photograph of a colour chart",
    .usage = "CHART.jpg|SESSION -o COLOUR.json",
    .documentation =
        "Example: weft colour chart.nef -o colour.json\n\n"
        "Finds a colour chart in a photograph, in any orientation, and the matrix from the camera's colours "
        "under this lamp to linear sRGB. White stays white: white balance and exposure are those of the white "
        "patches in each photograph of the sample, and are not in the matrix. Give the result to --colour of "
        "capture, register and photographs. Use a raw file, with the lamp and the lens of the sample.",
    .options = option_table,
    .needs = "a photograph of a colour chart and -o COLOUR.json",
    .surplus = "one photograph at a time",
    .run = run,
};
