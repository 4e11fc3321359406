#include "cli/command/arguments.h"
#include "compress/bard/predict.h"

#include <stdio.h>
#include <string.h>

typedef struct bard_command {
    weft_common_options common;
    const char *input, *output;
    weft_bard_options options;
} bard_command;

static const char *const map_words[] = {"plane", "printed", NULL};

static const weft_option option_table[] = {
    {.argument = "NAME.btf.h5",
     .is_required = true,
     .kind = WEFT_OPTION_INPUT,
     .offset = offsetof(bard_command, input)},
    {"output", 'o', "NAME.bard.h5", "The dataset to write", .is_required = true, .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(bard_command, output)},
    {"diffuse", .argument = "SHARE",
     .help = "Diffuse share, 0 to 1, of the smallest value of a texel under the light along the normal; it is neither "
             "mapped nor scaled (default: 1; the article's black satin: 0)",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(bard_command, options.diffuse_share), .low = 0, .high = 1},
    {"map", .argument = "WHICH",
     .help = "plane: turn the view in its plane (default); printed: the article's eqs. 9 and 10",
     .kind = WEFT_OPTION_CHOICE, .offset = offsetof(bard_command, options.map), .words = map_words},
    {0},
};

static void say_ring(const weft_common_options *common, const char *name, const weft_error_summary *error)
{
    weft_command_say(common, "%-12s  %12ld  %11.2f %%  %13.2f %%", name, error->count, 100 * error->relative_rmse,
                     100 * error->median_relative);
    char event[256];
    snprintf(event, sizeof event,
             "{\"event\":\"prediction\",\"lights\":\"%s\",\"values\":%ld,\"relative_rmse\":%.6g,"
             "\"median_relative\":%.6g}",
             name, error->count, error->relative_rmse, error->median_relative);
    weft_command_event(common, event);
}

static void say_report(const bard_command *command, const weft_bard_report *report)
{
    const weft_common_options *common = &command->common;
    weft_command_say(common, "%s: predicted from %d photographs of %d, lit within %.1f degrees of the normal",
                     command->output, report->photograph_count, report->image_count, report->largest_tilt_deg);
    if (report->filled_count > 0 || report->empty_texel_count > 0)
        weft_command_say(common, "masked: %ld samples taken from the nearest valid view; %ld texels without any",
                         report->filled_count, report->empty_texel_count);
    weft_command_say(common, "lights              values  relative RMSE  median relative");
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        char name[24];
        snprintf(name, sizeof name, "%d degrees", 15 * ring);
        if (report->by_light[ring].count > 0)
            say_ring(common, name, &report->by_light[ring]);
    }
    say_ring(common, "all", &report->all);
}

static int run(int argc, char **argv)
{
    bard_command command = {.options = weft_bard_defaults()};
    weft_arguments_parse(&weft_command_bard, argc, argv, &command);
    weft_progress progress = weft_command_progress(&command.common);
    weft_bard_report report;
    weft_error error = {0};
    weft_dataset *dataset = NULL;
    weft_code code = weft_dataset_open(command.input, &dataset, &error);
    if (code == WEFT_OK)
        code = weft_bard_predict(dataset, command.output, &command.options, &progress, &report, &error);
    if (code == WEFT_OK)
        say_report(&command, &report);
    weft_dataset_close(dataset);
    return weft_command_exit("bard", &command.common, code, &error);
}

const weft_command weft_command_bard = {
    .name = "bard",
    .summary = "predict a dataset from the photographs under one light",
    .usage = "NAME.btf.h5 -o NAME.bard.h5",
    .documentation =
        "Example: weft bard satin.btf.h5 -o satin.bard.h5\n\n"
        "Predicts every image of a dataset from the photographs under one light, along the normal (BARD, made "
        "for satin). Prints the error against the other photographs, and writes a dataset of the same layout.",
    .options = option_table,
    .needs = "NAME.btf.h5 and -o NAME.bard.h5",
    .surplus = "one dataset at a time",
    .run = run,
};
