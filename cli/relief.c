#include "relief/relief.h"
#include "base/atomic_file.h"
#include "base/text/json_text.h"
#include "cli/command/arguments.h"
#include "cli/command/heights.h"
#include "relief/move.h"
#include "relief/page.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct relief_command {
    weft_common_options common;
    const char *input, *output, *report, *obj, *normal;
    bool move;
    weft_relief_options options;
} relief_command;

static weft_code read_range(const weft_option *option, const char *text, void *target, weft_error *error)
{
    double number[2];
    relief_command *command = target;
    WEFT_TRY(weft_option_numbers(option->name, text, 2, number, error));
    if (!(number[0] < number[1]))
        return weft_fail(error, WEFT_BAD_USAGE, "--range needs LOW,HIGH in mm, the lower one first; it is '%s'", text);
    command->options.low_mm = number[0];
    command->options.high_mm = number[1];
    return WEFT_OK;
}

static const char *const repeat_words[] = {"auto", "on", "off", NULL};

static const weft_option option_table[] = {
    {.argument = "NAME.btf.h5",
     .is_required = true,
     .kind = WEFT_OPTION_INPUT,
     .offset = offsetof(relief_command, input)},
    {"output", 'o', "OTHER.btf.h5", "Write a copy with the heights, and leave NAME.btf.h5 as it is",
     .kind = WEFT_OPTION_OUTPUT, .offset = offsetof(relief_command, output)},
    {"report", .argument = "DIR", .help = "Write a report with pictures into this folder", .kind = WEFT_OPTION_FOLDER,
     .offset = offsetof(relief_command, report)},
    {"obj", .argument = "FILE.obj", .help = "Write the surface too", .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(relief_command, obj)},
    {"normal", .argument = "FILE.png", .help = "Write its normals as a picture", .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(relief_command, normal)},
    {"range", .argument = "LOW,HIGH",
     .help = "Search between these heights, in mm above the plane of the texels (default: found)", .read = read_range},
    {"repeat", .argument = "WHICH",
     .help = "Whether the material continues at its opposite border: on, off, or auto (default): if the borders fit",
     .kind = WEFT_OPTION_CHOICE, .offset = offsetof(relief_command, options.repeat), .words = repeat_words},
    {"move", .argument = "on|off",
     .help = "Move the texels of OTHER.btf.h5 onto the plane that is found, for models without heights, such as lobes "
             "(default: off)",
     .kind = WEFT_OPTION_SWITCH, .offset = offsetof(relief_command, move)},
    {0},
};

static void say_report(const relief_command *command, const weft_relief_report *report, const char *output)
{
    const weft_common_options *common = &command->common;
    weft_heights_say(common, report);
    weft_command_say(common, "plane     %.3f mm above the plane of the texels", report->plane_mm);
    weft_command_say(common, "heights   searched from %.3f to %.3f mm in %d x %d places; the material %s",
                     report->low_mm, report->high_mm, report->width, report->height,
                     report->repeats ? "repeats" : "does not repeat");
    weft_command_say(common,
                     "left out  %d of %d views in turn: error %.1f %% flat, %.1f %% through the plane, %.1f %% through "
                     "the heights",
                     report->compared_count, report->view_count, 100 * report->error.flat, 100 * report->error.plane,
                     100 * report->error.heights);
    weft_command_say(common, "levels    the finest %d of %d gain", report->levels_used, report->level_count);
    if (command->move && report->verdict != WEFT_RELIEF_NOTHING)
        weft_command_say(common, "texels    moved by %.3f mm, onto that plane", report->plane_mm);
    weft_command_say(common, "%s: written", output);
}

/* The surface that was decided for: heights, or a plane of as many places. */
static weft_code write_surfaces(const relief_command *command, const weft_relief_report *report,
                                const weft_dataset_heights *heights, weft_error *error)
{
    if (command->obj)
        WEFT_TRY(weft_surface_write_obj(command->obj, heights, report->width_mm, report->height_mm, error));
    if (command->normal)
        WEFT_TRY(weft_surface_write_normals(command->normal, heights, report->width_mm, report->height_mm, error));
    return WEFT_OK;
}

static weft_code keep(const relief_command *command, const weft_relief_report *report, weft_error *error)
{
    const char *output = command->output ? command->output : command->input;
    weft_code code = weft_relief_keep(command->input, output, report, error);
    if (code == WEFT_OK)
        say_report(command, report, output);
    return code;
}

/* The same dataset on the plane that was found, from where its heights count then. */
static weft_code move(const relief_command *command, const weft_relief_report *report, weft_error *error)
{
    bool has_heights = report->verdict == WEFT_RELIEF_HEIGHTS;
    weft_dataset_heights heights = {report->width, report->height, report->levels_used, NULL};
    const weft_move how = {report->plane_mm, report->repeats, has_heights ? &heights : NULL};
    weft_progress progress = weft_command_progress(&command->common);
    size_t count = (size_t)report->width * (size_t)report->height;
    weft_dataset *dataset;
    json_t *made = weft_relief_report_pack(report);
    weft_json_put(&made, "moved", json_true());
    weft_json_put(&made, "moved_mm", json_real(report->plane_mm + report->moved_mm));
    heights.value = malloc(count * sizeof *heights.value);
    weft_code code = made && heights.value ? weft_dataset_open(command->input, &dataset, error)
                                           : weft_fail_memory(error, "heights", count * sizeof *heights.value);
    for (size_t i = 0; code == WEFT_OK && i < count; i++)
        heights.value[i] = report->height_mm_of[i] - (float)report->plane_mm;
    if (code == WEFT_OK) {
        code = weft_relief_move(dataset, &how, command->output, json_incref(made), &progress, error);
        weft_dataset_close(dataset);
    }
    weft_dataset_heights_free(&heights);
    json_decref(made);
    if (code == WEFT_OK)
        say_report(command, report, command->output);
    return code;
}

static weft_code write_results(const relief_command *command, weft_relief_report *report, weft_error *error)
{
    if (command->report)
        WEFT_TRY(weft_relief_page_write(command->report, command->input, report, error));
    bool moves = command->move && report->verdict != WEFT_RELIEF_NOTHING;
    WEFT_TRY(moves ? move(command, report, error) : keep(command, report, error));
    const weft_dataset_heights surface = {report->width, report->height, 1, report->height_mm_of};
    double plane = report->verdict == WEFT_RELIEF_PLANE ? report->plane_mm : 0;
    for (int i = 0; report->verdict != WEFT_RELIEF_HEIGHTS && i < surface.width * surface.height; i++)
        surface.value[i] = (float)plane;
    return write_surfaces(command, report, &surface, error);
}

static weft_code estimate(const relief_command *command, weft_relief_report *report, weft_error *error)
{
    weft_dataset *dataset;
    weft_progress progress = weft_command_progress(&command->common);
    WEFT_TRY(weft_output_check(command->output ? command->output : command->input, error));
    WEFT_TRY(weft_dataset_open(command->input, &dataset, error));
    weft_code code = weft_relief_estimate(dataset, &command->options, &progress, report, error);
    weft_dataset_close(dataset);
    return code;
}

static weft_code check(void *values, weft_error *error)
{
    const relief_command *command = values;
    if (command->move && (!command->output || weft_is_same_file(command->input, command->output)))
        return weft_fail(error, WEFT_BAD_USAGE, "--move writes another dataset: give its name with -o");
    return WEFT_OK;
}

static int run(int argc, char **argv)
{
    relief_command command = {0};
    weft_arguments_parse(&weft_command_relief, argc, argv, &command);
    weft_error error = {0};
    weft_relief_report report;
    weft_code code = estimate(&command, &report, &error);
    if (code == WEFT_OK) {
        code = write_results(&command, &report, &error);
        weft_relief_report_free(&report);
    }
    return weft_command_exit("relief", &command.common, code, &error);
}

const weft_command weft_command_relief = {
    .name = "relief",
    .summary = "find the heights of a dataset in the parallax of its photographs",
    .usage = "NAME.btf.h5",
    .documentation = "Example: weft relief knit.btf.h5 --report knit-relief\n\n"
                     "Finds the height at which the views of a place agree. The dataset keeps heights if they predict "
                     "left-out views better than the best plane does; else the plane, if it is better than none; else "
                     "nothing.",
    .options = option_table,
    .needs = "NAME.btf.h5",
    .surplus = "one dataset at a time",
    .check = check,
    .run = run,
};
