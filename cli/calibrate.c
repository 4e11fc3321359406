#include "base/text/json_text.h"
#include "btf/session/camera_list.h"
#include "capture/plan.h"
#include "cli/command/arguments.h"
#include "cli/command/describe.h"
#include "registration/axes/calibration.h"
#include "registration/registration.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct calibrate_command {
    weft_common_options common;
    const char *session, *output, *plan;
    int lens;
} calibrate_command;

enum { LENS_HELD, LENS_FREE };

static const char *const lens_words[] = {"held", "free", NULL};

static const weft_option option_table[] = {
    {.argument = "SESSION",
     .is_required = true,
     .kind = WEFT_OPTION_INPUT,
     .offset = offsetof(calibrate_command, session)},
    {"output", 'o', "POSES.json", "Where the axes truly are", .is_required = true, .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(calibrate_command, output)},
    {"plan", .argument = "ubo81|ubo151|FILE.csv",
     .help = "Predict the errors for this plan: the views of 81 directions (default) or 151, or those of a table as "
             "weft capture takes it",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(calibrate_command, plan)},
    {"lens", .argument = "WHICH",
     .help = "held (default): keep the lens; free: find it with the axes, as far as the photographs determine it",
     .kind = WEFT_OPTION_CHOICE, .offset = offsetof(calibrate_command, lens), .words = lens_words},
    {0},
};

/* Lobes of glossy cloth are some degrees wide: a direction known better than this is as good as any. */
static const double direction_limit_deg = 0.2;

/* ---- The capture run ---- */

typedef struct prediction {
    weft_expectation expectation;
    int views, unreachable; /* of the plan */
    double allowed_texels;  /* as far as registration looks */
    bool finds, directs;    /* whether it will find the target, and directions are well enough known */
    bool good_enough;       /* both, in every view */
} prediction;

static bool is_new_view(const weft_plan *plan, int shot)
{
    /* Shots of one view follow each other. */
    const weft_angles *now = &plan->shot[shot].view, *before = shot > 0 ? &plan->shot[shot - 1].view : NULL;
    return !before || now->theta_rad != before->theta_rad || now->phi_rad != before->phi_rad;
}

static int list_turns(const weft_axes_sightings *sightings, const weft_plan *plan, weft_turns *turns, prediction *n)
{
    int count = 0;
    for (int shot = 0; shot < plan->shot_count; shot++) {
        if (!is_new_view(plan, shot))
            continue;
        n->views++;
        if (weft_axes_turns_like(sightings->shot, sightings->count, plan->shot[shot].view, &turns[count]))
            count++;
    }
    n->unreachable = n->views - count;
    return count;
}

static weft_code expect(const weft_session *session, const weft_axes_sightings *sightings, const weft_plan *plan,
                        const weft_axes_fit *fit, const weft_rig_poses *nominal, prediction *n, weft_error *error)
{
    weft_registration_settings settings = weft_registration_defaults(session);
    double opening_mm = session->target.opening_mm;
    weft_turns *turns = calloc((size_t)plan->shot_count, sizeof *turns);
    if (!turns)
        return weft_fail_memory(error, "plan", (size_t)plan->shot_count * sizeof *turns);
    int count = list_turns(sightings, plan, turns, n);
    weft_code code = weft_axes_expect(fit, nominal, opening_mm, settings.width, turns, count, &n->expectation, error);
    free(turns);
    n->allowed_texels = settings.limits.tolerance_mm * settings.width / opening_mm;
    n->finds = 3 * n->expectation.worst.texels < n->allowed_texels;
    n->directs = weft_deg_of_rad(n->expectation.direction_rad) < direction_limit_deg;
    n->good_enough = count > 0 && n->unreachable == 0 && n->finds && n->directs;
    return code;
}

/* ---- Messages ---- */

static void say_left_out(const weft_common_options *common, const weft_axes_sightings *sightings)
{
    for (int i = 0; i < sightings->count; i++)
        if (sightings->shot[i].left_out[0])
            weft_command_say(common, "left out %s: %s", sightings->shot[i].name, sightings->shot[i].left_out);
}

static void say_prediction(const weft_common_options *common, const prediction *n)
{
    const weft_expectation *e = &n->expectation;
    const weft_expected_pose *worst = &e->worst;
    if (n->unreachable > 0)
        weft_command_say(common,
                         "%d of the %d views of the plan are not predicted: they need an axis that did not turn in "
                         "these shots",
                         n->unreachable, n->views);
    if (e->poses == 0) {
        weft_command_say(common,
                         "NOT good enough: no view of the plan is reached; turn the same axes in the shots as in "
                         "the plan");
        return;
    }
    weft_command_say(common,
                     "predicted before registration refines them, %d poses: %.3f texels of 64 median, %.3f worst",
                     e->poses, e->median_texels, worst->texels);
    weft_command_say(common,
                     "  the worst with turns of %.1f %.1f %.1f degrees: %.3f from the uncertainty of the axes, %.3f "
                     "from poor repeatability",
                     worst->turns.deg[0], worst->turns.deg[1], worst->turns.deg[2], worst->model_texels,
                     worst->scatter_texels);
    weft_command_say(common, "  the direction of a view: %.4f degrees at worst", weft_deg_of_rad(e->direction_rad));
    if (n->finds && n->directs && !n->good_enough)
        weft_command_say(common, "good enough for %d of the %d views: registration searches %.0f texels", e->poses,
                         n->views, n->allowed_texels);
    else if (n->good_enough)
        weft_command_say(common, "good enough: registration searches %.0f texels", n->allowed_texels);
    else if (worst->scatter_texels > worst->model_texels)
        weft_command_say(common, "NOT good enough: the axes do not repeat; look for play, raise backlash_deg and "
                                 "settle_s in the rig file, and fasten the target");
    else
        weft_command_say(common,
                         "NOT good enough: the shots do not determine the axes; take more, over the whole range of "
                         "every axis");
}

/* They are off by chance, from shot to shot, so the error falls with the root of the number of shots
 * (docs/notes/capture.md#what-can-be-known). */
static void say_more_shots(const weft_common_options *common, const weft_axes_report *report)
{
    double worst_rad = 0;
    for (int k = 0; k < WEFT_JOINTS; k++)
        worst_rad = fmax(worst_rad, report->file.error[k].direction_rad);
    if (worst_rad == 0)
        return;
    double angle_deg = weft_deg_of_rad(worst_rad * sqrt(2)); /* of two components */
    weft_command_say(common,
                     "  lines are known to %.3f degrees by these %d shots; to %.3f by %d, to %.3f by %d like them",
                     angle_deg, report->used, angle_deg / sqrt(2), 2 * report->used, angle_deg / 2, 4 * report->used);
}

static void say_poses(const calibrate_command *command, const weft_axes_sightings *sightings,
                      const weft_axes_report *report, const prediction *n)
{
    const weft_common_options *common = &command->common;
    const weft_poses_file *file = &report->file;
    weft_command_say(common,
                     "%s: %d of %d shots; points are %.3f pixels off in shots that were not fitted, %.3f in those "
                     "that were (RMS)",
                     command->output, report->used, sightings->count, file->held_out_rms_px, file->rms_px);
    weft_command_say_lines(common, "  ", &report->found);
    say_more_shots(common, report);
    weft_command_say_lines(common, "", &report->undetermined);
    weft_command_say(common, "The camera cannot see the axes of the light; they stay as specified.");
    say_prediction(common, n);
}

static json_t *pack_joint(const weft_poses_file *file, int k)
{
    const weft_joint_error *e = &file->error[k];
    const weft_joint *joint = &file->poses.joint[k];
    return json_pack("{ss s[fff] s[fff] sf sf sf}", "turns", weft_joint_text[k], "direction", joint->direction.x,
                     joint->direction.y, joint->direction.z, "point_mm", joint->point.x, joint->point.y, joint->point.z,
                     "scale", joint->scale, "direction_error_deg", weft_deg_of_rad(e->direction_rad), "point_error_mm",
                     e->point_mm);
}

static json_t *pack_poses(const weft_axes_sightings *sightings, const weft_axes_report *report, const prediction *n)
{
    const weft_poses_file *file = &report->file;
    const weft_expectation *e = &n->expectation;
    json_t *joints = json_array(), *undetermined = json_array();
    for (int k = 0; k < WEFT_JOINTS; k++)
        weft_json_append(&joints, pack_joint(file, k));
    for (int i = 0; i < report->undetermined.count; i++)
        weft_json_append(&undetermined, json_string(report->undetermined.line[i]));
    return json_pack("{si si sf sf sf sf sf so so si si so so so sf sb}", "shots", sightings->count, "used",
                     report->used, "held_out_rms_px", file->held_out_rms_px, "rms_px", file->rms_px, "point_px",
                     file->point_px, "scatter_deg", weft_deg_of_rad(file->scatter_rad), "scatter_mm", file->scatter_mm,
                     "joints", joints, "not_told", undetermined, "poses", e->poses, "unreachable", n->unreachable,
                     "expected_median_texels", weft_json_number(e->median_texels), "expected_worst_texels",
                     weft_json_number(e->worst.texels), "expected_direction_deg",
                     weft_json_number(weft_deg_of_rad(e->direction_rad)), "allowed_texels", n->allowed_texels,
                     "good_enough", n->good_enough);
}

/* ---- Running ---- */

static weft_code write_poses(const calibrate_command *command, const weft_axes_sightings *sightings,
                             const weft_axes_report *report, weft_error *error)
{
    weft_lens_photograph *shot = calloc((size_t)sightings->count, sizeof *shot);
    if (!shot)
        return weft_fail_memory(error, "shots", (size_t)sightings->count * sizeof *shot);
    for (int i = 0; i < sightings->count; i++) {
        const weft_axes_shot *s = &sightings->shot[i];
        shot[i] = (weft_lens_photograph){s->name, s->left_out[0] ? s->left_out : NULL};
    }
    weft_code code =
        weft_poses_write(command->output, &report->file, shot, sightings->count,
                         (const char *const *)report->undetermined.line, report->undetermined.count, error);
    free(shot);
    return code;
}

static weft_code finish(const calibrate_command *command, const weft_session *session,
                        const weft_axes_sightings *sightings, const weft_plan *plan, const weft_rig_poses *nominal,
                        const weft_axes_report *report, weft_error *error)
{
    prediction n = {0};
    WEFT_TRY(expect(session, sightings, plan, &report->fit, nominal, &n, error));
    WEFT_TRY(write_poses(command, sightings, report, error));
    say_poses(command, sightings, report, &n);
    return weft_command_report(&command->common, "poses", pack_poses(sightings, report, &n), error);
}

static weft_code calibrate(const calibrate_command *command, const weft_session *session, const weft_plan *plan,
                           weft_error *error)
{
    weft_progress progress = weft_command_progress(&command->common);
    weft_rig_poses nominal = weft_rig_poses_nominal(&session->camera, session->camera_distance_mm);
    weft_axes_sightings sightings;
    weft_axes_report report;
    WEFT_TRY(weft_axes_sightings_read(session, &progress, &sightings, error));
    weft_code code =
        weft_axes_calibrate(sightings.shot, sightings.count, &nominal, command->lens == LENS_FREE, &report, error);
    say_left_out(&command->common, &sightings);
    if (code == WEFT_OK)
        code = finish(command, session, &sightings, plan, &nominal, &report, error);
    weft_axes_report_free(&report);
    weft_axes_sightings_free(&sightings);
    return code;
}

static int run(int argc, char **argv)
{
    calibrate_command command = {.plan = "ubo81"};
    weft_session session;
    weft_plan plan;
    weft_error error = {0};
    weft_arguments_parse(&weft_command_calibrate, argc, argv, &command);
    weft_code code = weft_plan_read(command.plan, &plan, &error);
    if (code == WEFT_OK) {
        code = weft_camera_session_open(command.session, &session, &error);
        if (code == WEFT_OK) {
            code = calibrate(&command, &session, &plan, &error);
            weft_session_free(&session);
        }
        weft_plan_free(&plan);
    }
    return weft_command_exit("calibrate", &command.common, code, &error);
}

const weft_command weft_command_calibrate = {
    .name = "calibrate",
    .summary = "calibrate the axes of a rig from photographs of the target",
    .usage = "SESSION -o POSES.json",
    .documentation =
        "Example: weft calibrate series/ -o rig.poses.json\n\n"
        "Finds the axes that turn camera and sample, and where the camera looks, from a session of about 20 "
        "photographs of the target over the whole range of the axes (assets/plans/calibration.csv). Predicts "
        "the pose errors of a capture run. The rig file names the result under 'poses'.",
    .options = option_table,
    .needs = "SESSION and -o POSES.json",
    .surplus = "one session at a time",
    .run = run,
};
