#include "registration/photographs/photographs.h"
#include "base/atomic_file.h"
#include "btf/session/lens.h"
#include "cli/command/arguments.h"
#include "registration/photographs/report.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

typedef struct photographs_command {
    weft_common_options common;
    const char *input, *output, *report_folder, *lens, *colour, *lights;
    double opening_mm, paper_reflectance;
    weft_photographs_settings settings;
} photographs_command;

enum { LARGEST_SIZE = 8192 };

static const weft_option option_table[] = {
    {.argument = "FOLDER",
     .is_required = true,
     .kind = WEFT_OPTION_INPUT,
     .offset = offsetof(photographs_command, input)},
    {"output", 'o', "NAME.btf.h5", "The dataset to write", .is_required = true, .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(photographs_command, output)},
    {"opening", .argument = "MM", .help = "Side of the target's opening as printed", .usual = "50",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(photographs_command, opening_mm), .low = 1, .high = 10000},
    {"size", 's', "WxH", "Texels of the opening (default: 256x256)", .kind = WEFT_OPTION_SIZE,
     .offset = offsetof(photographs_command, settings.width), .high = LARGEST_SIZE},
    {"lens", .argument = "LENS.json", .help = "The lens, from weft lens (default: found in the photographs)",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(photographs_command, lens)},
    {"colour", .argument = "COLOUR.json",
     .help = "The colours of the camera under the lamp, from weft colour (default: those of the camera are kept)",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(photographs_command, colour)},
    {"flash", .help = "The lamp is the camera's flash, or fixed to the camera", .kind = WEFT_OPTION_FLAG,
     .offset = offsetof(photographs_command, settings.flash)},
    {"balls", .argument = "MM", .help = "Diameter of the mirror balls on the sheet; 0: there are none (default: 20)",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(photographs_command, settings.ball_diameter_mm), .low = 0,
     .high = 1000},
    {"pin", .argument = "MM", .help = "Height of the pin on the sheet; 0: there is none (default: 30)",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(photographs_command, settings.pin_height_mm), .low = 0,
     .high = 200},
    {"lights", .argument = "FILE", .help = "What is known of the lamps: an .lp file, or a table (.csv)",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(photographs_command, lights)},
    {"paper", .argument = "SHARE", .help = "Reflectance of the bare paper, 0 to 1", .usual = "0.85",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(photographs_command, paper_reflectance), .low = 0.01, .high = 1},
    {"report", .argument = "DIR", .help = "Write a report with pictures into this folder", .kind = WEFT_OPTION_FOLDER,
     .offset = offsetof(photographs_command, report_folder)},
    {"force", .help = "Write the dataset although the photographs contradict each other", .kind = WEFT_OPTION_FLAG,
     .offset = offsetof(photographs_command, settings.force)},
    {"linear", .help = "8- and 16-bit files hold linear values, without a tone curve", .kind = WEFT_OPTION_FLAG,
     .offset = offsetof(photographs_command, settings.linear)},
    {0},
};

static void say_left_out(const photographs_command *command, const weft_photograph_set *set)
{
    for (int i = 0; i < set->count; i++) {
        if (!weft_photographs_used(&set->photograph[i]))
            weft_command_say(&command->common, "left out '%s': %s", set->photograph[i].name, set->photograph[i].remark);
    }
}

static void say_lens(const photographs_command *command, const weft_lens_estimate *lens)
{
    const weft_camera *c = &lens->camera;
    const weft_lens_errors *e = &lens->errors;
    if (lens->knowledge == WEFT_LENS_UNKNOWN)
        weft_command_say(&command->common,
                         "lens: focal length %.1f +- %.1f pixels, k1 %.4f +- %.4f, k2 %.4f +- %.4f (standard errors); "
                         "markers lie %.2f pixels off, RMS",
                         c->fx, e->focal_px, c->k1, e->k1, c->k2, e->k2, lens->rms_px);
    else
        weft_command_say(&command->common,
                         "lens: focal length %.1f pixels, as %s; k1 %.4f, k2 %.4f; markers lie %.2f pixels off, RMS",
                         c->fx, lens->knowledge == WEFT_LENS_KNOWN ? "--lens gives it" : "the camera wrote it", c->k1,
                         c->k2, lens->rms_px);
}

static void say_outcome(const photographs_command *command, const weft_photograph_set *set)
{
    say_left_out(command, set);
    weft_command_say_lines(&command->common, "", &set->notes);
    say_lens(command, &set->lens);
    char words[WEFT_PHOTOGRAPHS_TEXT_SIZE];
    weft_photographs_describe_tone(set, words);
    weft_command_say(&command->common, "tone curve: %s", words);
    weft_photographs_describe_masks(set, &command->settings, words);
    weft_command_say(&command->common, "masks: %s", words);
    if (command->settings.colour)
        weft_command_say(&command->common,
                         "colours: linear sRGB; mean error of a held-out patch of the chart: %.2f CIEDE2000",
                         command->settings.colour->left_out.mean);
    weft_command_say(&command->common, "%s: %d x %d texels, %d of %d photographs, %.0f s", command->output,
                     command->settings.width, command->settings.height, set->used_count, set->count, set->seconds);
}

/* Hours of work must not end at a folder that cannot be written. */
static weft_code check_report_folder(const char *folder, weft_error *error)
{
    WEFT_TRY(weft_make_folder(folder, error));
    return access(folder, W_OK | X_OK) == 0 ? WEFT_OK : weft_fail_errno(error, "write into", folder);
}

static int run(int argc, char **argv)
{
    photographs_command command = {.settings = weft_photographs_defaults()};
    weft_arguments_parse(&weft_command_photographs, argc, argv, &command);
    weft_progress progress = weft_command_progress(&command.common);
    command.settings.target = weft_target_printed(command.opening_mm);
    command.settings.target.paper_reflectance = command.settings.target.white_reflectance = command.paper_reflectance;
    weft_photograph_set set;
    weft_error error = {0};
    weft_lens lens;
    weft_colour colour;
    weft_light_list lights = {0};
    weft_code code = command.lens ? weft_lens_read(command.lens, &lens, &error) : WEFT_OK;
    if (command.lens)
        command.settings.lens = &lens.camera;
    if (code == WEFT_OK && command.colour)
        code = weft_colour_read(command.colour, &colour, &error);
    if (command.colour)
        command.settings.colour = &colour;
    if (code == WEFT_OK && command.lights)
        code = weft_light_list_read(command.lights, &lights, &error);
    if (command.lights)
        command.settings.lights = &lights;
    if (code == WEFT_OK && command.report_folder)
        code = check_report_folder(command.report_folder, &error);
    if (code == WEFT_OK)
        code = weft_photographs_register(command.input, command.output, &command.settings, &progress, &set, &error);
    if (code == WEFT_OK) {
        say_outcome(&command, &set);
        if (command.report_folder)
            code = weft_photographs_report(command.report_folder, command.output, &command.settings, &set, &error);
        weft_photographs_free(&set);
    }
    weft_light_list_free(&lights);
    return weft_command_exit("photographs", &command.common, code, &error);
}

const weft_command weft_command_photographs = {
    .name = "photographs",
    .summary = "turn your own photographs of the printed target into a dataset",
    .usage = "FOLDER -o NAME.btf.h5",
    .documentation = "Example: weft photographs felt/ -o felt.btf.h5 --opening 50\n\n"
                     "Turns a folder of photographs of a sample in the printed target (weft target) into a dataset. "
                     "Names and order do not matter. Lens, poses, lamps, exposures and the camera's tone curve are "
                     "found in the photographs. Those that cannot be used are left out and named.",
    .options = option_table,
    .needs = "a folder of photographs and -o NAME.btf.h5",
    .surplus = "one folder at a time",
    .run = run,
};
