#include "cli/arguments.h"
#include "cli/command.h"
#include "study/bard/predict.h"

#include <stdio.h>
#include <string.h>

typedef struct bard_command {
    conversion files;
    weft_bard_options options;
} bard_command;

enum { KEY_DIFFUSE = 0x2000, KEY_MAP };

static const struct argp_option option_table[] = {
    {"output", 'o', "NAME.bard.h5", 0, "The dataset to write", 0},
    {"diffuse", KEY_DIFFUSE, "SHARE", 0,
     "Share, 0 to 1, of a texel's smallest value under the light along the normal that is diffuse: neither mapped nor "
     "scaled (default: 1; the article's black satin has none, 0)",
     0},
    {"map", KEY_MAP, "WHICH", 0, "plane: turn the view in its plane (default); printed: the article's eqs. 9 and 10",
     0},
    {0},
};

static weft_bard_map map_argument(const char *text, struct argp_state *state)
{
    if (strcmp(text, "plane") != 0 && strcmp(text, "printed") != 0)
        argp_error(state, "--map is plane or printed, not '%s'", text);
    return strcmp(text, "printed") == 0 ? WEFT_BARD_PRINTED : WEFT_BARD_IN_PLANE;
}

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    bard_command *command = state->input;
    switch (key) {
    case KEY_DIFFUSE:
        command->options.diffuse_share = parse_number("diffuse", argument, 0, 1, state);
        return 0;
    case KEY_MAP:
        command->options.map = map_argument(argument, state);
        return 0;
    default:
        return parse_conversion(key, argument, state, &command->files);
    }
}

static const struct argp_child children[] = {{&common_argp, 0, "Common options:", 9}, {0}};

static const struct argp parser = {option_table,
                                   parse_option,
                                   "NAME.btf.h5 -o NAME.bard.h5",
                                   "Example: weft bard satin.btf.h5 -o satin.bard.h5\n\n"
                                   "Predicts every image of a dataset from the photographs under one light, the one "
                                   "along the normal (BARD, made for satin), says how far the predictions are from "
                                   "the other photographs, and writes them as a dataset of the same layout.",
                                   children,
                                   NULL,
                                   NULL};

static void say_ring(const common_options *common, const char *name, const weft_error_summary *error)
{
    command_say(common, "%-12s  %12ld  %13.4f  %15.4f", name, error->count, error->relative_rmse,
                error->median_relative);
    char event[256];
    snprintf(event, sizeof event,
             "{\"event\":\"prediction\",\"lights\":\"%s\",\"values\":%ld,\"relative_rmse\":%.6g,"
             "\"median_relative\":%.6g}",
             name, error->count, error->relative_rmse, error->median_relative);
    command_event(common, event);
}

static void say_report(const bard_command *command, const weft_bard_report *report)
{
    const common_options *common = &command->files.common;
    command_say(common, "%s: predicted from %d photographs of %d, lit within %.1f degrees of the normal",
                command->files.output, report->photograph_count, report->image_count, report->largest_tilt_deg);
    if (report->filled_count > 0 || report->empty_texel_count > 0)
        command_say(common, "masked: %ld samples taken from the nearest valid view; %ld texels without any",
                    report->filled_count, report->empty_texel_count);
    command_say(common, "lights              values  relative RMSE  median relative");
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        char name[24];
        snprintf(name, sizeof name, "%d degrees", 15 * ring);
        if (report->by_light[ring].count > 0)
            say_ring(common, name, &report->by_light[ring]);
    }
    say_ring(common, "all", &report->all);
}

int command_bard(int argc, char **argv)
{
    bard_command command = {.files = {.noun = "dataset", .needed = "NAME.btf.h5 and -o NAME.bard.h5"},
                            .options = weft_bard_defaults()};
    command_parse(&parser, argc, argv, &command, &command.files.common);
    weft_progress progress = command_progress(&command.files.common);
    weft_bard_report report;
    weft_error error = {0};
    weft_dataset *dataset = NULL;
    weft_code code = weft_dataset_open(command.files.input, &dataset, &error);
    if (code == WEFT_OK)
        code = weft_bard_predict(dataset, command.files.output, &command.options, &progress, &report, &error);
    if (code == WEFT_OK)
        say_report(&command, &report);
    weft_dataset_close(dataset);
    return command_exit("bard", &command.files.common, code, &error);
}
