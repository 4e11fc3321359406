#include "import/import.h"
#include "cli/arguments.h"
#include "cli/command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct import_command {
    conversion files;
    weft_import_options options;
} import_command;

enum { KEY_PITCH = 0x2000, KEY_SATURATED, KEY_VALUES, KEY_SKIP_BAD };

static const struct argp_option option_table[] = {
    {"output", 'o', "NAME.btf.h5", 0, "The dataset to write", 0},
    {"size", 's', "N", 0, "Reduce the photographs to N texels across by averaging areas", 0},
    {"pitch", KEY_PITCH, "MM", 0, "Size of a texel of the dataset (default: what the collection says, else 1)", 0},
    {"saturated", KEY_SATURATED, "LEVEL", 0,
     "Mask samples of 8-bit photographs from this level of 255; 256 masks none (default: 250)", 0},
    {"values", KEY_VALUES, "WHAT", 0, "What a sample holds: reflectance_cosine (default) or reflectance", 0},
    {"skip-bad", KEY_SKIP_BAD, 0, 0, "Mask photographs that cannot be used instead of stopping", 0},
    {0},
};

static weft_values values_argument(const char *text, struct argp_state *state)
{
    if (strcmp(text, "reflectance_cosine") != 0 && strcmp(text, "reflectance") != 0)
        argp_error(state, "--values is reflectance_cosine or reflectance, not '%s'", text);
    return strcmp(text, "reflectance") == 0 ? WEFT_REFLECTANCE : WEFT_REFLECTANCE_COSINE;
}

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    import_command *command = state->input;
    weft_import_options *options = &command->options;
    switch (key) {
    case 's':
        options->width = (int)parse_whole("size", argument, 1, 65536, state);
        return 0;
    case KEY_PITCH:
        options->texel_pitch_mm = parse_number("pitch", argument, 1e-6, 1e6, state);
        return 0;
    case KEY_SATURATED:
        options->saturated_at = parse_number("saturated", argument, 1, 256, state) / 255;
        return 0;
    case KEY_VALUES:
        options->values = values_argument(argument, state);
        return 0;
    case KEY_SKIP_BAD:
        options->skip_bad = true;
        return 0;
    default:
        return parse_conversion(key, argument, state, &command->files);
    }
}

static const struct argp_child children[] = {{&common_argp, 0, "Common options:", 9}, {0}};

static const struct argp parser = {option_table,
                                   parse_option,
                                   "SOURCE -o NAME.btf.h5",
                                   "Example: weft import photographs/ -o cloth.btf.h5 --size 256\n\n"
                                   "Turns a folder of photographs that others made into a dataset. The folder holds "
                                   "camera_pos.txt, light_pos.txt, image_size.txt and "
                                   "light_power.txt beside NN.png (near light and camera), or a directions.csv, or "
                                   "files named by their angles, such as "
                                   "tv045_pv090/tl030_pl120_tv045_pv090.png (light and camera far away).",
                                   children,
                                   NULL,
                                   NULL};

static void say_report(const import_command *command, const weft_import_report *report)
{
    const common_options *common = &command->files.common;
    for (int i = 0; i < report->notes.count; i++)
        command_say(common, "%s", report->notes.line[i]);
    command_say(common, "%s: %s, %d x %d texels, %d images from %d views", command->files.output, report->kind,
                report->width, report->height, report->image_count, report->view_count);
    command_say(common, "masked: %d missing, %d skipped, %.2f %% of the samples saturated", report->missing_count,
                report->skipped_count, 100 * report->saturated_fraction);
}

int command_import(int argc, char **argv)
{
    import_command command = {.files = {.noun = "folder", .needed = "a folder of photographs and -o NAME.btf.h5"},
                              .options = weft_import_defaults()};
    command_parse(&parser, argc, argv, &command, &command.files.common);
    weft_progress progress = command_progress(&command.files.common);
    weft_import_report report;
    weft_error error = {0};
    weft_code code =
        weft_import(command.files.input, command.files.output, &command.options, &progress, &report, &error);
    if (code == WEFT_OK) {
        say_report(&command, &report);
        weft_import_report_free(&report);
    }
    return command_exit("import", &command.files.common, code, &error);
}
