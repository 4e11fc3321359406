#include "cli/command/arguments.h"
#include "cli/command/heights.h"
#include "registration/registration.h"
#include "registration/report/report.h"

#include <stdio.h>

typedef struct register_command {
    weft_common_options common;
    const char *input, *output;
    bool heights;
    weft_register_options options;
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
     .offset = offsetof(register_command, options.width), .high = LARGEST_SIZE},
    {"colour", .argument = "COLOUR.json|FOLDER",
     .help = "Colours of the camera under the lamp, from weft colour; for several cameras, a folder with a file for "
             "each, CAMERA.json (default: those in the session, if any)",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(register_command, options.colour)},
    WEFT_HEIGHTS_OPTION(register_command, heights),
    {"report", .argument = "DIR", .help = "Write a report with pictures into this folder", .kind = WEFT_OPTION_FOLDER,
     .offset = offsetof(register_command, options.report_folder)},
    {"allow-unfinished", .help = "Register a session that is not finished", .kind = WEFT_OPTION_FLAG,
     .offset = offsetof(register_command, options.allow_unfinished)},
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
    if (command->options.report_folder)
        weft_command_say_page(&command->common, "report", r->settings.report_folder);
    return WEFT_OK;
}

static int run(int argc, char **argv)
{
    register_command command = {.heights = true};
    weft_arguments_parse(&weft_command_register, argc, argv, &command);
    weft_progress progress = weft_command_progress(&command.common);
    weft_error error = {0};
    weft_registered *found = NULL;
    weft_code code = weft_register_folder(command.input, command.output, &command.options, &progress, &found, &error);
    for (int i = 0; code == WEFT_OK && i < found->count; i++) {
        if (found->count > 1)
            weft_command_say(&command.common, "camera %s", found->session[i].folder);
        code = say_outcome(&command, &found->session[i], &found->registration[i], &error);
    }
    weft_registered_free(found);
    if (code == WEFT_OK && command.heights)
        weft_heights_look(&command.common, command.output);
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
