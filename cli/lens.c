#include "base/atomic_file.h"
#include "base/text/image_list.h"
#include "base/text/json_text.h"
#include "cli/command/arguments.h"
#include "cli/command/describe.h"
#include "registration/lens/calibration.h"

#include <sys/stat.h>

typedef struct lens_command {
    weft_common_options common;
    weft_lines input; /* folders and files */
    const char *output;
    int model;
    weft_lens_settings settings;
} lens_command;

enum { MODEL_CHOSEN, MODEL_FULL };

static const char *const model_words[] = {"chosen", "full", NULL};

static weft_code read_input(const weft_option *option, const char *text, void *target, weft_error *error)
{
    (void)option;
    return weft_lines_add(&((lens_command *)target)->input, error, "%s", text);
}

static weft_code read_board(const weft_option *option, const char *text, void *target, weft_error *error)
{
    (void)option;
    return weft_board_parse(text, &((lens_command *)target)->settings.board, error);
}

static const weft_option option_table[] = {
    {.argument = "FOLDER|FILE...", .kind = WEFT_OPTION_OTHER, .read = read_input, .repeats = true},
    {"board", .argument = "BOARD",
     .help = "The board, sizes in mm: plate:OPENING (the target), chessboard:COLUMNSxROWS:SQUARE (inner "
             "corners), charuco:COLUMNSxROWS:SQUARE,MARKER[:DICTIONARY] (squares), "
             "aruco:COLUMNSxROWS:MARKER,GAP[:DICTIONARY], apriltag:COLUMNSxROWS:TAG,GAP[:DICTIONARY]",
     .kind = WEFT_OPTION_OTHER, .read = read_board},
    {"output", 'o', "LENS.json", "The lens to write", .is_required = true, .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(lens_command, output)},
    {"model", .argument = "WHICH",
     .help = "chosen (default): fit those of k2, p1, p2, k3 that the photographs determine; full: fit all",
     .kind = WEFT_OPTION_CHOICE, .offset = offsetof(lens_command, model), .words = model_words},
    {0},
};

static weft_code check(void *values, weft_error *error)
{
    lens_command *command = values;
    if (command->input.count == 0 || !command->settings.board.text[0])
        return weft_fail(error, WEFT_BAD_USAGE, "needs %s", weft_command_lens.needs);
    for (int i = 0; i < command->input.count; i++)
        if (weft_is_same_file(command->input.line[i], command->output))
            return weft_fail(error, WEFT_BAD_USAGE, "'%s' would overwrite its own input", command->output);
    command->settings.full_model = command->model == MODEL_FULL;
    return WEFT_OK;
}

/* ---- Photographs ---- */

static weft_code add_folder(const char *folder, weft_lines *names, weft_error *error)
{
    weft_lines found;
    WEFT_TRY(weft_images_list(folder, &found, error));
    weft_code code = found.count > 0 ? WEFT_OK : weft_images_missing(folder, error);
    for (int i = 0; i < found.count && code == WEFT_OK; i++)
        code = weft_lines_add(names, error, "%s/%s", folder, found.line[i]);
    weft_lines_free(&found);
    return code;
}

static weft_code list_photographs(const weft_lines *input, weft_lines *names, weft_error *error)
{
    for (int i = 0; i < input->count; i++) {
        struct stat found;
        if (stat(input->line[i], &found) != 0)
            return weft_fail(error, WEFT_BAD_INPUT, "there is no '%s'", input->line[i]);
        WEFT_TRY(S_ISDIR(found.st_mode) ? add_folder(input->line[i], names, error)
                                        : weft_lines_add(names, error, "%s", input->line[i]));
    }
    return WEFT_OK;
}

/* ---- Messages ---- */

static void say_left_out(const weft_common_options *common, const weft_lens_report *report)
{
    for (int i = 0; i < report->count; i++)
        if (report->photograph[i].left_out)
            weft_command_say(common, "left out %s: %s", report->photograph[i].name, report->photograph[i].left_out);
    if (report->stray_count > 0)
        weft_command_say(common, "left out %d corners far from their predicted places", report->stray_count);
}

static void say_lens(const lens_command *command, const weft_lens_report *report)
{
    const weft_common_options *common = &command->common;
    const weft_lens *lens = &report->lens;
    weft_command_say(common, "%s: %d x %d pixels, %d of %d photographs, %d corners, RMS %.3f pixels", command->output,
                     lens->camera.width, lens->camera.height, report->used, report->count, report->point_count,
                     lens->rms_px);
    for (int i = 0; i < WEFT_LENS_PARAMETERS; i++)
        weft_command_say(common, "  %s %12.*f +- %.*f", weft_lens_parameter_name[i], i < 4 ? 3 : 6,
                         weft_lens_parameter(&lens->camera, i), i < 4 ? 3 : 6, lens->standard_error[i]);
    weft_command_say(common, "the focal length is known to %.2f %%, the middle to %.1f, %.1f pixels",
                     100 * report->focal_error, lens->standard_error[2], lens->standard_error[3]);
    weft_command_say_lines(common, "", &report->fixed);
    weft_command_say_lines(common, "warning: ", &report->warnings);
}

static void add_values(json_t **event, const weft_lens *lens)
{
    json_t *errors = json_object();
    for (int i = 0; i < WEFT_LENS_PARAMETERS; i++) {
        weft_json_put(event, weft_lens_parameter_name[i], json_real(weft_lens_parameter(&lens->camera, i)));
        weft_json_put(&errors, weft_lens_parameter_name[i], json_real(lens->standard_error[i]));
    }
    weft_json_put(event, "standard_error", errors);
}

static weft_code show_event(const lens_command *command, const weft_lens_report *report, weft_error *error)
{
    json_t *event = json_pack("{si si sf si si sf sf sf sf}", "width", report->lens.camera.width, "height",
                              report->lens.camera.height, "rms_px", report->lens.rms_px, "used", report->used,
                              "photographs", report->count, "tilt_deg", weft_deg_of_rad(report->tilt_rad), "reach",
                              report->reach, "pattern_px", report->pattern, "noise_px", report->noise);
    add_values(&event, &report->lens);
    return weft_command_report(&command->common, "lens", event, error);
}

static weft_code calibrate(lens_command *command, const weft_lines *names, weft_error *error)
{
    weft_progress progress = weft_command_progress(&command->common);
    weft_lens_report report;
    weft_code code = weft_lens_calibrate(&command->settings, names, &progress, &report, error);
    say_left_out(&command->common, &report);
    if (code == WEFT_OK)
        code = weft_lens_write(command->output, &report.lens, command->settings.board.text, report.photograph,
                               report.count, error);
    if (code == WEFT_OK) {
        say_lens(command, &report);
        code = show_event(command, &report, error);
    }
    weft_lens_report_free(&report);
    return code;
}

static int run(int argc, char **argv)
{
    lens_command command = {0};
    weft_lines names = {0};
    weft_error error = {0};
    weft_arguments_parse(&weft_command_lens, argc, argv, &command);
    weft_code code = list_photographs(&command.input, &names, &error);
    if (code == WEFT_OK)
        code = calibrate(&command, &names, &error);
    weft_lines_free(&names);
    weft_lines_free(&command.input);
    return weft_command_exit("lens", &command.common, code, &error);
}

const weft_command weft_command_lens = {
    .name = "lens",
    .summary = "calibrate the lens of a camera from photographs of a board",
    .usage = "FOLDER|FILE... --board BOARD -o LENS.json",
    .documentation =
        "Example: weft lens photographs/ --board charuco:7x9:28,21:5X5_100 -o lens.json\n\n"
        "Calibrates a camera from photographs of a board with known corners, all taken with one lens at one "
        "focus and zoom. 'weft target --board' prints such a board. Photographs that do not help are listed "
        "and left out. Pixels are taken as they are stored: the EXIF orientation is ignored, because the lens "
        "does not turn with the picture.",
    .options = option_table,
    .needs = "photographs, --board BOARD and -o LENS.json",
    .surplus = "any number of photographs",
    .check = check,
    .run = run,
};
