/* The capture with a rig that is no virtual one: it knows nothing but capture/rig.h. Links the core alone. */
#include "capture/capture.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SHOTS = 4, SIZE = 96, BITS = 12, BLACK = 64 };

static const char plan[] = "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n"
                           "30,0,0,0\n45,120,0,0\n60,240,40,90\n10,0,40,90\n";

/* A rig whose photographs are even, as bright as their exposure is long. */
typedef struct bench {
    int homings, first_viewpoint, moves, exposures, stops;
    int disturbances; /* photographs during which it will be pushed */
    bool homed, broken, light_on, jammed;

    weft_angles view;
} bench;

static weft_code home(void *device, int first_viewpoint, weft_error *error)
{
    bench *b = device;
    if (b->broken)
        return weft_fail(error, WEFT_SYSTEM, "bench stage: axis 2 does not find its reference");
    b->homings++;
    b->homed = true;
    b->first_viewpoint = first_viewpoint;
    b->view.theta_rad = -1;
    return WEFT_OK;
}

static weft_code move(void *device, weft_angles view, weft_angles light, bool *moved, weft_error *error)
{
    (void)light;
    bench *b = device;
    assert_true(b->homed);
    *moved = view.theta_rad != b->view.theta_rad || view.phi_rad != b->view.phi_rad;
    if (b->jammed && *moved && b->moves == 1)
        return weft_fail(error, WEFT_SYSTEM, "bench stage: axis 1 is stuck");
    b->view = view;
    b->moves += *moved;
    return WEFT_OK;
}

static weft_code held(void *device, bool *still, weft_error *error)
{
    (void)error;
    bench *b = device;
    *still = b->disturbances == 0;
    b->disturbances -= !*still;
    return WEFT_OK;
}

static void stop(void *device)
{
    ((bench *)device)->stops++;
}

/* Whoever asks gets the last first. */
static weft_code backwards(void *device, const weft_shot *shot, int count, int *numbers, weft_stage_estimate *estimate,
                           weft_error *error)
{
    (void)device;
    (void)shot;
    (void)error;
    for (int i = 0; i < count / 2; i++) {
        int number = numbers[i];
        numbers[i] = numbers[count - 1 - i];
        numbers[count - 1 - i] = number;
    }
    *estimate = (weft_stage_estimate){.seconds = 100, .moves = count - 1};
    return WEFT_OK;
}

/* Its lamps stand at full tens of degrees; there is none below 55. */
static weft_code reach(void *device, weft_shot *shot, weft_error *error)
{
    (void)device;
    double theta_deg = weft_deg_of_rad(shot->light.theta_rad);
    if (theta_deg > 55)
        return weft_fail(error, WEFT_BAD_INPUT, "bench stage: no lamp at %.0f degrees", theta_deg);
    shot->light_driven.theta_rad = weft_rad_of_deg(10 * round(theta_deg / 10));
    return WEFT_OK;
}

static weft_code power(void *device, bool on, weft_error *error)
{
    (void)error;
    ((bench *)device)->light_on = on;
    return WEFT_OK;
}

static weft_code expose(void *device, uint64_t frame, double exposure_s, uint16_t *samples, double *read_back_s,
                        weft_error *error)
{
    (void)frame;
    (void)error;
    assert_true(((bench *)device)->light_on);
    ((bench *)device)->exposures++;
    double value = fmin(BLACK + 1e5 * exposure_s, (1 << BITS) - 1);
    for (int i = 0; i < SIZE * SIZE * 3; i++)
        samples[i] = (uint16_t)value;
    /* As noise would, the number of the exposure tells photographs apart. */
    samples[0] = (uint16_t)((((bench *)device)->exposures + 100) % 4096);
    *read_back_s = exposure_s;
    return WEFT_OK;
}

static weft_rig rig_of(bench *b)
{
    weft_rig rig = {.name = "bench",
                    .sample = "a piece of paper",
                    .identity = "{\"lens\":\"75 mm\"}",
                    .settings = weft_rig_settings_default(),
                    .camera = {b, expose},
                    .stage = {.device = b, .home = home, .move = move},
                    .light = {b, power}};
    rig.settings.width_px = rig.settings.height_px = SIZE;
    rig.settings.focal_length_px = 440;
    rig.calibration = weft_rig_settings_camera(&rig.settings);
    return rig;
}

static weft_code run(weft_rig *rig, weft_capture_summary *summary, weft_error *error)
{
    const weft_capture_request request = {.folder = "session", .plan = "plan.csv"};
    weft_capture capture;
    scratch_store("plan.csv", plan, sizeof plan - 1);
    WEFT_TRY(weft_capture_begin(&request, rig, NULL, &capture, error));
    weft_code code = weft_capture_take(&capture, NULL, NULL, error);
    *summary = capture.summary;
    weft_capture_end(&capture);
    return code;
}

static void remove_session(void)
{
    assert_int_equal(system("rm -rf session"), 0);
}

static void the_session_remembers_what_the_rig_says_of_itself(void **state)
{
    (void)state;
    bench b = {0};
    weft_rig rig = rig_of(&b);
    weft_capture_summary summary;
    weft_session session;
    assert_int_equal(run(&rig, &summary, NULL), WEFT_OK);
    assert_int_equal(summary.taken, SHOTS);
    assert_int_equal(b.moves, 2);
    assert_int_equal(weft_session_open("session", &session, NULL), WEFT_OK);
    assert_string_equal(session.rig, "bench");
    assert_string_equal(session.sample, "a piece of paper");
    assert_string_equal(session.rig_settings, "{\"lens\":\"75 mm\"}");
    for (int shot = 0; shot < SHOTS; shot++)
        assert_int_equal(session.record[shot].viewpoint, shot / 2);
    weft_session_free(&session);
    remove_session();
}

static void the_stage_is_homed_once_and_told_how_many_viewpoints_there_were(void **state)
{
    (void)state;
    bench b = {.first_viewpoint = -1};
    weft_rig rig = rig_of(&b);
    weft_capture_summary summary;
    assert_int_equal(run(&rig, &summary, NULL), WEFT_OK);
    assert_int_equal(b.homings, 1);
    assert_int_equal(b.first_viewpoint, 0);
    /* Nothing is left to do: no axis moves. */
    assert_int_equal(run(&rig, &summary, NULL), WEFT_OK);
    assert_int_equal(b.homings, 1);
    assert_int_equal(system("find session -name '*tv040*.tif' -delete"), 0);
    assert_int_equal(run(&rig, &summary, NULL), WEFT_OK);
    assert_int_equal(summary.taken, 2);
    assert_int_equal(b.homings, 2);
    assert_int_equal(b.first_viewpoint, 2);
    remove_session();
}

static void a_stage_that_cannot_be_homed_ends_the_run_with_its_message(void **state)
{
    (void)state;
    bench b = {.broken = true};
    weft_rig rig = rig_of(&b);
    weft_capture_summary summary;
    weft_error error = {0};
    assert_int_equal(run(&rig, &summary, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "axis 2"));
    assert_int_equal(summary.taken, 0);
    remove_session();
}

static void another_rig_does_not_continue_a_session(void **state)
{
    (void)state;
    bench b = {0};
    weft_rig rig = rig_of(&b);
    weft_capture_summary summary;
    weft_error error = {0};
    assert_int_equal(run(&rig, &summary, NULL), WEFT_OK);
    rig.identity = "{\"lens\":\"50 mm\"}";
    assert_int_equal(run(&rig, &summary, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "another 'lens'"));
    rig = rig_of(&b);
    rig.name = "dome";
    assert_int_equal(run(&rig, &summary, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "with the rig 'bench', not 'dome'"));
    remove_session();
}

/* An arm whose scale begins at 10 degrees. */
static weft_code turns(void *device, const weft_shot *shot, weft_turns *at, weft_error *error)
{
    (void)device;
    (void)error;
    *at = (weft_turns){{weft_deg_of_rad(shot->view.theta_rad) + 10, weft_deg_of_rad(shot->view.phi_rad), 0}};
    return WEFT_OK;
}

/* Where the stage turns to, and where that is known to put the camera. */
static void the_session_knows_where_the_axes_put_the_camera(void **state)
{
    (void)state;
    bench b = {0};
    weft_rig rig = rig_of(&b);
    weft_rig_poses poses = weft_rig_poses_nominal(&rig.calibration, 500);
    weft_capture_summary summary;
    weft_session session;
    weft_error error = {0};
    rig.poses = &poses;
    rig.poses_path = "rig.poses.json";
    poses.camera.fx = 450;
    assert_int_equal(run(&rig, &summary, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "calibrated poses need a rig with axes"));
    rig.stage.turns = turns;
    assert_int_equal(run(&rig, &summary, NULL), WEFT_OK);
    assert_int_equal(weft_session_open("session", &session, NULL), WEFT_OK);
    assert_float_equal(session.camera.fx, 450, 0);
    assert_float_equal(session.turns[2].deg[WEFT_CAMERA_THETA], 50, 1e-9);
    weft_pose there = weft_session_pose(&session, session.shot[2].view);
    weft_angles seen_from = weft_pose_view(&there);
    assert_float_equal(weft_deg_of_rad(seen_from.theta_rad), 50, 1e-6);
    weft_session_free(&session);
    poses.joint[0].scale = 0.001;
    assert_int_equal(run(&rig, &summary, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "begun with other poses of the rig"));
    rig.poses = NULL;
    assert_int_equal(run(&rig, &summary, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "begun with other poses of the rig"));
    remove_session();
}

static void assert_poses_are_refused(weft_rig *rig, const weft_rig_poses *poses, const char *said)
{
    weft_capture_summary summary;
    weft_error error = {0};
    rig->poses = poses;
    assert_int_equal(run(rig, &summary, &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, said) || !strstr(error.message, "'rig.poses.json'"))
        fail_msg("'%s' does not say '%s'", error.message, said);
}

/* Of photographs of another size, of another lens; and such as put the camera behind or below the plate. */
static void poses_that_are_not_of_the_rig_are_refused(void **state)
{
    (void)state;
    bench b = {0};
    weft_rig rig = rig_of(&b);
    rig.poses_path = "rig.poses.json";
    rig.stage.turns = turns;
    const weft_rig_poses sound = weft_rig_poses_nominal(&rig.calibration, 500);
    weft_rig_poses poses = sound;
    poses.camera.height = 80;
    assert_poses_are_refused(&rig, &poses, "is for photographs of 96 x 80 pixels, the lens is for 96 x 96");
    poses = sound;
    poses.camera.k1 += 0.01;
    assert_poses_are_refused(&rig, &poses, "another lens distortion or vignetting than the rig; calibrate again");
    poses = sound;
    poses.camera.vignetting[2] += 0.01;
    assert_poses_are_refused(&rig, &poses, "another lens distortion or vignetting than the rig; calibrate again");
    poses = sound;
    poses.home.translation.z *= -1;
    assert_poses_are_refused(&rig, &poses, "does not see the plate from above, with turns of 10 0 0 degrees");
    poses = sound;
    poses.joint[WEFT_CAMERA_THETA].scale = 1;
    assert_poses_are_refused(&rig, &poses, "does not see the plate from above, with turns of 50 90 0 degrees");
}

static void a_photograph_during_which_the_stage_moved_is_taken_again(void **state)
{
    (void)state;
    bench still = {0}, pushed = {.disturbances = 2};
    weft_rig rig = rig_of(&still);
    weft_capture_summary summary;
    assert_int_equal(run(&rig, &summary, NULL), WEFT_OK);
    remove_session();
    rig = rig_of(&pushed);
    rig.stage.held = held;
    assert_int_equal(run(&rig, &summary, NULL), WEFT_OK);
    assert_int_equal(summary.taken, SHOTS);
    assert_int_equal(summary.disturbed, 2);
    assert_true(pushed.exposures >= still.exposures + 2);
    remove_session();
}

static void a_stage_that_never_keeps_still_ends_the_run(void **state)
{
    (void)state;
    bench b = {.disturbances = 1000};
    weft_rig rig = rig_of(&b);
    rig.stage.held = held;
    rig.stage.stop = stop;
    weft_capture_summary summary;
    weft_error error = {0};
    assert_int_equal(run(&rig, &summary, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "did not keep its pose during shot 0"));
    assert_int_equal(summary.taken, 0);
    assert_int_equal(b.stops, 1);
    remove_session();
}

static void whatever_fails_the_axes_stop_and_the_light_goes_off(void **state)
{
    (void)state;
    bench b = {.jammed = true};
    weft_rig rig = rig_of(&b);
    rig.stage.stop = stop;
    weft_capture_summary summary;
    weft_error error = {0};
    assert_int_equal(run(&rig, &summary, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "axis 1 is stuck"));
    assert_int_equal(summary.taken, 2);
    assert_int_equal(b.stops, 1);
    assert_false(b.light_on);
    remove_session();
}

static void the_stage_chooses_the_order_and_knows_how_long_it_takes(void **state)
{
    (void)state;
    bench b = {0};
    weft_rig rig = rig_of(&b);
    rig.stage.order = backwards;
    weft_capture_summary summary;
    weft_session session;
    assert_int_equal(run(&rig, &summary, NULL), WEFT_OK);
    assert_int_equal(weft_session_open("session", &session, NULL), WEFT_OK);
    for (int shot = 0; shot < SHOTS; shot++)
        assert_int_equal(session.record[shot].viewpoint, 1 - shot / 2);
    weft_session_free(&session);
    remove_session();
    const weft_capture_request request = {.folder = "session", .plan = "plan.csv"};
    weft_capture_rehearsal rehearsal;
    int homings = b.homings;
    rig.seconds_per_photograph = 2;
    assert_int_equal(weft_capture_rehearse(&request, &rig, &rehearsal, NULL), WEFT_OK);
    assert_int_equal(rehearsal.order[0], SHOTS - 1);
    assert_float_equal(rehearsal.stage.seconds, 100, 0);
    assert_float_equal(rehearsal.seconds_per_photograph, 2, 0);
    assert_int_equal(b.homings, homings); /* nothing moved */
    weft_capture_rehearsal_free(&rehearsal);
}

static void a_pose_out_of_reach_is_refused_before_anything_is_written(void **state)
{
    (void)state;
    bench b = {0};
    weft_rig rig = rig_of(&b);
    rig.stage.reach = reach;
    weft_capture_summary summary;
    weft_error error = {0};
    assert_int_equal(run(&rig, &summary, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "no lamp at 60 degrees"));
    assert_int_equal(scratch_folder_entries(), 1); /* the plan */
}

int test_any_rig(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_session_remembers_what_the_rig_says_of_itself),
        cmocka_unit_test(the_stage_is_homed_once_and_told_how_many_viewpoints_there_were),
        cmocka_unit_test(a_stage_that_cannot_be_homed_ends_the_run_with_its_message),
        cmocka_unit_test(another_rig_does_not_continue_a_session),
        cmocka_unit_test(the_session_knows_where_the_axes_put_the_camera),
        cmocka_unit_test(poses_that_are_not_of_the_rig_are_refused),
        cmocka_unit_test(a_photograph_during_which_the_stage_moved_is_taken_again),
        cmocka_unit_test(a_stage_that_never_keeps_still_ends_the_run),
        cmocka_unit_test(whatever_fails_the_axes_stop_and_the_light_goes_off),
        cmocka_unit_test(the_stage_chooses_the_order_and_knows_how_long_it_takes),
        cmocka_unit_test(a_pose_out_of_reach_is_refused_before_anything_is_written),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
