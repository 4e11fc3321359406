#include "weft/import.h"
#include "cli/command/arguments.h"
#include "cli/command/heights.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct import_command {
    weft_common_options common;
    const char *input, *output;
    bool heights;
    weft_import_options options;
} import_command;

/* In the order of weft_import_colours. */
static const char *const colour_words[] = {"file", "srgb", "gamma-2.2", "adobe-rgb", "display-p3", "xyz", NULL};
static const char *const value_words[] = {"reflectance_cosine", "reflectance", NULL};

static const weft_option option_table[] = {
    {.argument = "SOURCE", .is_required = true, .kind = WEFT_OPTION_INPUT, .offset = offsetof(import_command, input)},
    {"output", 'o', "NAME.btf.h5", "The dataset to write", .is_required = true, .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(import_command, output)},
    {"size", 's', "N", "Reduce the photographs to N texels across by averaging areas", .kind = WEFT_OPTION_WHOLE,
     .offset = offsetof(import_command, options.width), .low = 1, .high = 65536},
    {"pitch", .argument = "MM", .help = "Size of a texel of the dataset (default: as the collection says, else 1)",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(import_command, options.texel_pitch_mm), .low = 1e-6, .high = 1e6},
    {"saturated", .argument = "LEVEL",
     .help = "Mask samples of 8-bit photographs at or above this level (default: 250; 256 masks none)",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(import_command, options.saturated_at), .low = 1, .high = 256,
     .divisor = 255},
    {"values", .argument = "WHAT",
     .help = "Quantity of the samples: reflectance_cosine or reflectance (default: as the file says, else the first)",
     .kind = WEFT_OPTION_CHOICE, .offset = offsetof(import_command, options.values), .words = value_words},
    {"lights", .argument = "FILE.lp", .help = "Direction of the lamp of every photograph; all have one view",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(import_command, options.lights)},
    {"colours", .argument = "SPACE",
     .help = "Colours of the photographs: srgb, gamma-2.2, adobe-rgb, display-p3, xyz, or file (default): as each file "
             "says, else srgb",
     .kind = WEFT_OPTION_CHOICE, .offset = offsetof(import_command, options.colours), .words = colour_words},
    {"white", .argument = "LEVEL", .help = "Linear value of a perfect white diffuser in the photographs (default: 1)",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(import_command, options.white), .low = 1e-6, .high = 65504},
    {"linear", .help = "8- and 16-bit photographs hold linear values, without a tone curve", .kind = WEFT_OPTION_FLAG,
     .offset = offsetof(import_command, options.linear)},
    WEFT_HEIGHTS_OPTION(import_command, heights),
    {"skip-bad", .help = "Mask photographs that cannot be used, and leave out duplicates, instead of stopping",
     .kind = WEFT_OPTION_FLAG, .offset = offsetof(import_command, options.skip_bad)},
    {0},
};

static void say_report(const import_command *command, const weft_import_report *report)
{
    const weft_common_options *common = &command->common;
    weft_command_say_lines(common, "", &report->notes);
    weft_command_say(common, "%s: %s, %d x %d texels, %d images from %d views", command->output, report->kind,
                     report->width, report->height, report->image_count, report->view_count);
    weft_command_say(common, "masked: %d missing, %d skipped, %.2f %% of the samples saturated", report->missing_count,
                     report->skipped_count, 100 * report->saturated_fraction);
    if (report->outside_fraction > 0)
        weft_command_say(common, "colours outside sRGB: %.2f %% of the samples, kept with a negative channel",
                         100 * report->outside_fraction);
}

static int run(int argc, char **argv)
{
    import_command command = {.heights = true, .options = weft_import_defaults()};
    weft_arguments_parse(&weft_command_import, argc, argv, &command);
    weft_progress progress = weft_command_progress(&command.common);
    weft_import_report report;
    weft_error error = {0};
    weft_code code = weft_import(command.input, command.output, &command.options, &progress, &report, &error);
    if (code == WEFT_OK) {
        say_report(&command, &report);
        weft_import_report_free(&report);
    }
    if (code == WEFT_OK && command.heights)
        weft_heights_look(&command.common, command.output);
    return weft_command_exit("import", &command.common, code, &error);
}

const weft_command weft_command_import = {
    .name = "import",
    .summary = "turn photographs of others into a dataset",
    .usage = "SOURCE -o NAME.btf.h5",
    .documentation =
        "Example: weft import photographs/ -o cloth.btf.h5 --size 256\n\n"
        "Turns a folder of photographs that others took, or a .btf file of the University of Bonn (UBO2014), "
        "into a dataset. The folder holds one of these: camera_pos.txt, light_pos.txt, image_size.txt and "
        "light_power.txt beside NN.png (near light and camera); a directions.csv; an .lp file (one view, many "
        "lamps); files named by their angles, such as tv045_pv090/tl030_pl120_tv045_pv090.png (far light and "
        "camera).",
    .options = option_table,
    .needs = "a folder of photographs or a .btf file, and -o NAME.btf.h5",
    .surplus = "one folder or file at a time",
    .run = run,
};
