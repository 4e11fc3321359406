#include "base/atomic_file.h"
#include "btf/session/camera_list.h"
#include "cli/command/arguments.h"
#include "cli/command/heights.h"
#include "registration/registration.h"
#include "registration/report/report.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

typedef struct register_command {
    weft_common_options common;
    const char *input, *output, *report_folder, *colour;
    int width, height;
    bool allow_unfinished, heights;
} register_command;

enum { LARGEST_SIZE = 8192 };

static const weft_option option_table[] = {
    {.argument = "SESSION",
     .is_required = true,
     .kind = WEFT_OPTION_INPUT,
     .offset = offsetof(register_command, input)},
    {"output", 'o', "NAME.btf.h5", "The dataset to write", .is_required = true, .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(register_command, output)},
    {"size", 's', "WxH", "Texels of the opening (default: 64x64)", .kind = WEFT_OPTION_SIZE,
     .offset = offsetof(register_command, width), .high = LARGEST_SIZE},
    {"colour", .argument = "COLOUR.json|FOLDER",
     .help = "Colours of the camera under the lamp, from weft colour; for several cameras, a folder with a file for "
             "each, CAMERA.json (default: those in the session, if any)",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(register_command, colour)},
    WEFT_HEIGHTS_OPTION(register_command, heights),
    {"report", .argument = "DIR", .help = "Write a report with pictures into this folder", .kind = WEFT_OPTION_FOLDER,
     .offset = offsetof(register_command, report_folder)},
    {"allow-unfinished", .help = "Register a session that is not finished", .kind = WEFT_OPTION_FLAG,
     .offset = offsetof(register_command, allow_unfinished)},
    {0},
};

static void say_faults(const register_command *command, const weft_session *session, const weft_registration *r)
{
    for (int viewpoint = 0; viewpoint < r->survey.viewpoint_count; viewpoint++) {
        const weft_viewpoint *one = &r->survey.viewpoint[viewpoint];
        if (r->pose[viewpoint].remark[0])
            weft_command_say(&command->common, "view %s, viewpoint %d: %s%s",
                             weft_view_name_of(r->survey.view[one->view]).text, one->viewpoint,
                             r->pose[viewpoint].source == WEFT_POSE_FAILED ? "masked: " : "kept the markers' pose: ",
                             r->pose[viewpoint].remark);
    }
    for (int shot = 0; shot < session->shot_count; shot++) {
        if (r->fault[shot].reason[0])
            weft_command_say(&command->common, "masked: %s", r->fault[shot].reason);
    }
    if (r->estimated_whites)
        weft_command_say(&command->common,
                         "%d photographs show no usable white patches; they use the power of the lamp in the others",
                         r->estimated_whites);
}

static weft_code say_outcome(const register_command *command, const weft_session *session, const weft_registration *r,
                             weft_error *error)
{
    weft_registration_summary all;
    WEFT_TRY(weft_registration_summarise(session, r, &all, error));
    say_faults(command, session, r);
    weft_command_say(&command->common, "%s: %d x %d texels, %d of %d photographs, %d of %d viewpoints registered",
                     command->output, r->settings.width, r->settings.height, r->image_count, session->shot_count,
                     r->survey.viewpoint_count - r->failed_viewpoints, r->survey.viewpoint_count);
    weft_command_say(
        &command->common,
        "random error of a position, estimated: %.4f texels median, %.4f worst; %.3f %% of the samples saturated",
        all.median_uncertainty, all.worst_uncertainty, 100 * all.saturated);
    if (r->found.bend.viewpoints > 0)
        weft_command_say(
            &command->common,
            "corrected: the plate, bent by %.3f mm at its rim (random error %.4f), and vignetting of %.2f %% beside "
            "the calibration (standard error %.2f)",
            weft_bend_depth_mm(&r->found.bend), r->found.bend.standard_error_mm,
            100 * weft_vignetting_loss(&r->found.vignetting), 100 * r->found.vignetting.standard_error);
    const weft_sensor_summary *sensor = &r->found.sensor;
    if (sensor->dark_frames > 0)
        weft_command_say(&command->common,
                         "the sensor, from %d + %d dark frames: %.3g raw values per second subtracted; %d hot pixels "
                         "masked",
                         sensor->dark_frames, sensor->dark_frames, sensor->dark_rate, sensor->hot);
    if (sensor->flat_frames > 0)
        weft_command_say(&command->common,
                         "the sensor, from %d flat frames: a response of %.1f to %.1f %% divided out, %+.2f %% toward "
                         "the rim; %d dead pixels masked",
                         sensor->flat_frames, 100 * sensor->least, 100 * sensor->most, 100 * sensor->fall_off,
                         sensor->dead);
    weft_lamp_drift drift = weft_lamp_drift_of(r);
    if (drift.viewpoints > 1)
        weft_command_say(&command->common,
                         "the lamp changed by %+.2f to %+.2f %% over %d viewpoints; each photograph is corrected by "
                         "its white patches",
                         100 * drift.lowest, 100 * drift.highest, drift.viewpoints);
    if (session->colour.terms > 0)
        weft_command_say(&command->common,
                         "colours: linear sRGB; mean error of a held-out patch of the chart: %.2f CIEDE2000",
                         session->colour.left_out.mean);
    if (command->report_folder)
        weft_command_say_page(&command->common, "report", r->settings.report_folder);
    return WEFT_OK;
}

/* One camera, or several. */
typedef struct cameras {
    int count;
    weft_camera_list list;
    weft_session *session;                                 /* [count] */
    weft_registration_settings settings[WEFT_CAMERAS_MAX]; /* [count] */
    char report_folder[WEFT_CAMERAS_MAX][PATH_MAX];
    weft_registration registration[WEFT_CAMERAS_MAX]; /* [count] */
} cameras;

/* Of one camera, the report lies in the folder asked for; of several, in a folder of each. */
static weft_code choose_settings(const register_command *command, cameras *c, weft_error *error)
{
    if (c->list.count > 0 && command->report_folder)
        WEFT_TRY(weft_make_folder(command->report_folder, error));
    for (int i = 0; i < c->count; i++) {
        weft_registration_settings *settings = &c->settings[i];
        *settings = weft_registration_defaults(&c->session[i]);
        settings->width = command->width;
        settings->height = command->height;
        settings->allow_unfinished = command->allow_unfinished;
        settings->report_folder = command->report_folder;
        if (c->list.count == 0 || !command->report_folder)
            continue;
        snprintf(c->report_folder[i], sizeof c->report_folder[i], "%s/%s", command->report_folder, c->list.name[i]);
        settings->report_folder = c->report_folder[i];
    }
    return WEFT_OK;
}

/* What is the same for all cameras must be told of one model: the colours of another are others. */
static weft_code take_one_colour(const register_command *command, cameras *c, weft_error *error)
{
    weft_colour colour;
    WEFT_TRY(weft_colour_read(command->colour, &colour, error));
    for (int i = 0; i < c->count; i++)
        c->session[i].colour.terms = 0;
    WEFT_TRY(weft_camera_sessions_agree(c->session, c->count, error));
    for (int i = 0; i < c->count; i++)
        c->session[i].colour = colour;
    return WEFT_OK;
}

static weft_code take_colour_of_each(const register_command *command, cameras *c, weft_error *error)
{
    for (int i = 0; i < c->count; i++) {
        char path[PATH_MAX];
        WEFT_TRY(weft_camera_file(command->colour, c->list.name[i], path, sizeof path, error));
        WEFT_TRY(weft_colour_read(path, &c->session[i].colour, error));
    }
    return WEFT_OK;
}

static weft_code take_colour(const register_command *command, cameras *c, weft_error *error)
{
    char path[PATH_MAX];
    if (!command->colour)
        return WEFT_OK;
    bool is_file = weft_camera_file(command->colour, NULL, path, sizeof path, error) == WEFT_OK;
    if (is_file)
        return take_one_colour(command, c, error);
    return c->list.count > 0 ? take_colour_of_each(command, c, error) : WEFT_BAD_INPUT;
}

static weft_code register_all(const register_command *command, cameras *c, const weft_progress *progress,
                              weft_error *error)
{
    WEFT_TRY(weft_camera_list_read(command->input, &c->list, error));
    WEFT_TRY(choose_settings(command, c, error));
    WEFT_TRY(take_colour(command, c, error));
    WEFT_TRY(
        weft_register_cameras(c->session, c->count, command->output, c->settings, progress, c->registration, error));
    weft_code code = WEFT_OK;
    for (int i = 0; i < c->count; i++) {
        if (c->count > 1)
            weft_command_say(&command->common, "camera %s", c->session[i].folder);
        if (code == WEFT_OK)
            code = say_outcome(command, &c->session[i], &c->registration[i], error);
        weft_registration_free(&c->registration[i]);
    }
    return code;
}

static int run(int argc, char **argv)
{
    register_command command = {.width = 64, .height = 64, .heights = true};
    weft_arguments_parse(&weft_command_register, argc, argv, &command);
    weft_progress progress = weft_command_progress(&command.common);
    weft_error error = {0};
    static cameras c;
    weft_code code = weft_camera_sessions_open(command.input, &c.session, &c.count, &error);
    if (code != WEFT_OK)
        return weft_command_exit("register", &command.common, code, &error);
    code = register_all(&command, &c, &progress, &error);
    if (code == WEFT_OK && command.heights)
        weft_heights_look(&command.common, command.output);
    weft_camera_sessions_free(c.session, c.count);
    return weft_command_exit("register", &command.common, code, &error);
}

const weft_command weft_command_register = {
    .name = "register",
    .summary = "turn the photographs of a session into a dataset",
    .usage = "SESSION -o NAME.btf.h5",
    .documentation =
        "Example: weft register session/ -o cloth.btf.h5 --size 64x64 --report report/\n\n"
        "Finds where the camera stood for every view, rectifies the photographs, calibrates them by the white "
        "patches, and writes a dataset. Unusable photographs are listed and masked. Texels beside the frame "
        "that a view does not see are masked, too.",
    .options = option_table,
    .needs = "a session and -o NAME.btf.h5",
    .surplus = "one session at a time",
    .run = run,
};
