/* A stage on USB through the real libhidapi, with all that can go wrong between a computer and its axes. Runs under
 * umockdev-wrapper. */
#include "capture/capture.h"
#include "capture/motion/controller.h"
#include "capture/motion/stage.h"
#include "tests/capture/fake_controller.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- A rig of it ---- */

static const weft_axes goniometer = {.count = FAKE_AXES,
                                     .together = true,
                                     .axis = {{.name = "camera arm",
                                               .moves = WEFT_BODY_CAMERA,
                                               .angle = WEFT_TURN_THETA,
                                               .channel = 0,
                                               .low_deg = -2,
                                               .high_deg = 90,
                                               .speed_deg_s = 1000,
                                               .acceleration_deg_s2 = 1e4,
                                               .backlash_deg = 0.4},
                                              {.name = "camera ring",
                                               .moves = WEFT_BODY_CAMERA,
                                               .angle = WEFT_TURN_PHI,
                                               .channel = 1,
                                               .low_deg = -2,
                                               .high_deg = 361,
                                               .speed_deg_s = 1000,
                                               .acceleration_deg_s2 = 1e4,
                                               .backlash_deg = 0.4},
                                              {.name = "light arm",
                                               .moves = WEFT_BODY_LIGHT,
                                               .angle = WEFT_TURN_THETA,
                                               .channel = 2,
                                               .low_deg = -2,
                                               .high_deg = 90,
                                               .speed_deg_s = 1000,
                                               .acceleration_deg_s2 = 1e4,
                                               .backlash_deg = 0.4},
                                              {.name = "light ring",
                                               .moves = WEFT_BODY_LIGHT,
                                               .angle = WEFT_TURN_PHI,
                                               .channel = 3,
                                               .low_deg = -2,
                                               .high_deg = 361,
                                               .speed_deg_s = 1000,
                                               .acceleration_deg_s2 = 1e4,
                                               .backlash_deg = 0.4}}};

/* Short, so that lost answers cost little; with so many retries a machine that stalls for seconds is no fault. */
static const double timeout_s = 0.06;

typedef struct bench {
    fake_controller fake;
    weft_axes axes;
    volatile sig_atomic_t stop;
    weft_controller *controller;
    weft_stage *stage;
    weft_rig_stage rig;
    weft_rig_light light;
} bench;

/* A test that fails leaves it open: its device must not be plugged in again while its testbed is taken away. */
static bench *opened;

static void open_bench_with(bench *b, UMockdevTestbed *testbed, const weft_axes *axes)
{
    *b = (bench){.axes = *axes};
    opened = b;
    fake_controller_start(&b->fake, testbed);
    const weft_controller_settings settings = {.address = {0x1209, 0xb7f1, "ST-0001"},
                                               .timeout_s = timeout_s,
                                               .retries = 100,
                                               .replug_s = 20,
                                               .tolerance_deg = 0.01,
                                               .stop = &b->stop};
    assert_int_equal(weft_controller_create(&settings, &b->axes, &b->controller, NULL), WEFT_OK);
    const weft_stage_parts parts = {.axes = &b->axes,
                                    .controller = b->controller,
                                    .lamps = weft_controller_lamps(b->controller),
                                    .level = 0.5,
                                    .retries = 3};
    assert_int_equal(weft_stage_create(&parts, &b->stage, NULL), WEFT_OK);
    b->rig = weft_stage_for_rig(b->stage);
    b->light = weft_stage_light(b->stage);
}

static void open_bench(bench *b, UMockdevTestbed *testbed)
{
    open_bench_with(b, testbed, &goniometer);
    weft_error error = {0};
    if (b->rig.home(b->rig.device, 0, &error) != WEFT_OK)
        fail_msg("%s", error.message);
}

static void close_bench(bench *b)
{
    opened = NULL;
    weft_stage_free(b->stage);
    weft_controller_free(b->controller);
    fake_controller_end(&b->fake);
}

static double off_by(double a_deg, double b_deg)
{
    return fabs(remainder(a_deg - b_deg, 360));
}

/* The farthest that any axis stands from where a pose has it, degrees. */
static double wrong_by(bench *b, weft_angles view, weft_angles light)
{
    const double wanted[FAKE_AXES] = {weft_deg_of_rad(view.theta_rad), weft_deg_of_rad(view.phi_rad),
                                      weft_deg_of_rad(light.theta_rad), weft_deg_of_rad(light.phi_rad)};
    double worst = 0;
    for (int axis = 0; axis < FAKE_AXES; axis++)
        worst = fmax(worst, off_by(fake_stage_truth(&b->fake.stage, axis) + fake_backlash_deg, wanted[axis]));
    return worst;
}

static unsigned random_below(unsigned limit)
{
    static uint64_t state = 5;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (unsigned)(state >> 33) % limit;
}

/* ---- Faults ---- */

/* One of twenty of 2000 moves goes wrong in some way; no pose is believed that is not taken.
 */
static void faults_in_two_thousand_moves_give_no_wrong_pose(void **state)
{
    enum { MOVES = 2000, ONE_IN = 20 };
    static bench b;
    open_bench(&b, *state);
    int wrong = 0, refused = 0, viewpoints = 0, armed = 0;
    for (int i = 0; i < MOVES; i++) {
        weft_angles view = weft_ubo81_angles(i / 9 % 81), light = weft_ubo81_angles((int)random_below(81));
        weft_error error = {0};
        bool moved, held = false;
        if (i % ONE_IN == 7)
            fake_stage_arm(&b.fake.stage, (fake_fault)(1 + armed++ % (FAKE_FAULTS - 1)), (int)random_below(8));
        weft_code code = b.rig.move(b.rig.device, view, light, &moved, &error);
        if (code == WEFT_OK)
            code = b.rig.held(b.rig.device, &held, &error);
        if (code != WEFT_OK) {
            refused++;
            print_message("move %d: %s\n", i, error.message);
            assert_true(error.message[0]);
            b.rig.stop(b.rig.device);
            continue;
        }
        viewpoints += moved;
        wrong += held && wrong_by(&b, view, light) > 0.02;
    }
    print_message("%d faults, %d wrong poses, %d moves refused, %d stays, %d times plugged in again\n", armed, wrong,
                  refused, viewpoints, b.fake.plugged);
    for (int fault = 1; fault < FAKE_FAULTS; fault++)
        assert_true(b.fake.stage.injected[fault] >= MOVES / ONE_IN / FAKE_FAULTS - 1);
    assert_int_equal(wrong, 0);
    assert_int_equal(refused, 0);
    /* Where it lost its references, what follows is a new viewpoint. */
    assert_true(viewpoints > (MOVES + 8) / 9);
    close_bench(&b);
}

static void lost_and_broken_answers_are_asked_for_again(void **state)
{
    static const fake_fault faults[] = {FAKE_LATE, FAKE_LOST, FAKE_DOUBLED, FAKE_BROKEN, FAKE_STALE, FAKE_DEAF};
    static bench b;
    open_bench(&b, *state);
    bool moved;
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
        fake_stage_arm(&b.fake.stage, faults[i], 0);
        weft_angles view = weft_ubo81_angles((int)i + 1);
        assert_int_equal(b.rig.move(b.rig.device, view, view, &moved, NULL), WEFT_OK);
        assert_true(moved && wrong_by(&b, view, view) < 0.02);
        assert_int_equal(b.fake.stage.injected[faults[i]], 1);
    }
    assert_int_equal(b.fake.plugged, 0);
    close_bench(&b);
}

static void an_axis_that_stalls_for_good_is_named_and_all_stand_still(void **state)
{
    static bench b;
    open_bench(&b, *state);
    weft_error error = {0};
    bool moved;
    b.fake.stage.hardware.touch_speed[1] = 0;
    b.fake.stage.firmware.hardware.touch_speed[1] = 0; /* the motor of the ring is dead whenever it must be slow */
    fake_stage_arm(&b.fake.stage, FAKE_LIMIT, 0);
    assert_int_equal(b.rig.move(b.rig.device, weft_ubo81_angles(40), weft_ubo81_angles(60), &moved, &error),
                     WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "axis 'camera ring' stalled"));
    for (int axis = 0; axis < FAKE_AXES; axis++)
        assert_float_equal(b.fake.stage.speed[axis], 0, 0);
    close_bench(&b);
}

static void a_controller_that_stays_away_is_named(void **state)
{
    static bench b;
    open_bench_with(&b, *state, &goniometer);
    weft_controller_free(b.controller);
    const weft_controller_settings settings = {
        .address = {0x1209, 0xb7f1, ""}, .timeout_s = timeout_s, .retries = 2, .replug_s = 0.2, .tolerance_deg = 0.01};
    assert_int_equal(weft_controller_create(&settings, &b.axes, &b.controller, NULL), WEFT_OK);
    weft_move_failure failure;
    weft_error error = {0};
    assert_int_equal(weft_controller_home(b.controller, 15, &failure, NULL), WEFT_OK);
    b.fake.stays_away = true;
    fake_stage_arm(&b.fake.stage, FAKE_UNPLUGGED, 1);
    weft_axis_positions to = {{10, 20, 30, 40}};
    assert_int_equal(weft_controller_move(b.controller, 15, &to, &failure, &error), WEFT_SYSTEM);
    assert_int_equal(failure, WEFT_MOVE_OVER);
    assert_non_null(strstr(error.message, "there is no USB device 1209:b7f1"));
    close_bench(&b);
}

static void a_serial_number_chooses_among_controllers(void **state)
{
    static bench b;
    open_bench_with(&b, *state, &goniometer);
    weft_usb_link link = {.address = {0x1209, 0xb7f1, "ST-0002"}};
    weft_error error = {0};
    assert_int_equal(weft_usb_link_open(&link, 0, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "ST-0002"));
    link.address.serial = "ST-0001";
    assert_int_equal(weft_usb_link_open(&link, 0, &error), WEFT_OK);
    weft_usb_link_close(&link);
    close_bench(&b);
}

/* ---- Stopping ---- */

static void a_stop_in_mid_move_halts_the_axes(void **state)
{
    static bench b;
    open_bench(&b, *state);
    weft_error error = {0};
    bool moved;
    for (int axis = 0; axis < FAKE_AXES; axis++)
        b.fake.stage.firmware.hardware.speed[axis] = 1000; /* slow enough to be caught */
    b.stop = 1;
    assert_int_equal(b.rig.move(b.rig.device, weft_ubo81_angles(80), weft_ubo81_angles(80), &moved, &error),
                     WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "stopped"));
    for (int axis = 0; axis < FAKE_AXES; axis++)
        assert_float_equal(b.fake.stage.speed[axis], 0, 0);
    /* And goes on from there, homed again: nobody knows what the operator did meanwhile. */
    b.stop = 0;
    for (int axis = 0; axis < FAKE_AXES; axis++)
        b.fake.stage.firmware.hardware.speed[axis] = 1000000;
    assert_int_equal(b.rig.move(b.rig.device, weft_ubo81_angles(80), weft_ubo81_angles(80), &moved, NULL), WEFT_OK);
    assert_true(moved && wrong_by(&b, weft_ubo81_angles(80), weft_ubo81_angles(80)) < 0.02);
    close_bench(&b);
}

static void limits_hold_in_the_host_and_in_the_device(void **state)
{
    static bench b;
    open_bench(&b, *state);
    weft_move_failure failure;
    weft_error error = {0};
    weft_axis_positions to = {{91, 0, 0, 0}};
    assert_int_equal(weft_controller_move(b.controller, 1, &to, &failure, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "axis 'camera arm' may not go to 91 degrees"));
    close_bench(&b);
    weft_axes wide = goniometer;
    wide.axis[2].high_deg = 95; /* beyond what is built in */
    open_bench_with(&b, *state, &wide);
    assert_int_equal(b.rig.home(b.rig.device, 0, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "does not allow axis 'light arm' from -2 to 95"));
    close_bench(&b);
}

/* ---- A pose that is not kept ---- */

static void a_push_is_noticed_and_the_next_pose_is_true_again(void **state)
{
    static bench b;
    open_bench(&b, *state);
    weft_angles pose = weft_ubo81_angles(33);
    bool moved, held;
    assert_int_equal(b.rig.move(b.rig.device, pose, pose, &moved, NULL), WEFT_OK);
    assert_int_equal(b.rig.held(b.rig.device, &held, NULL), WEFT_OK);
    assert_true(held);
    assert_int_equal(b.rig.move(b.rig.device, pose, pose, &moved, NULL), WEFT_OK);
    assert_false(moved);
    fake_stage_push(&b.fake.stage, 3, 0.3);
    fake_stage_push(&b.fake.stage, 3, -0.3);
    assert_int_equal(b.rig.held(b.rig.device, &held, NULL), WEFT_OK);
    assert_false(held);
    assert_int_equal(b.rig.move(b.rig.device, pose, pose, &moved, NULL), WEFT_OK);
    assert_true(moved && wrong_by(&b, pose, pose) < 0.02);
    assert_int_equal(b.rig.held(b.rig.device, &held, NULL), WEFT_OK);
    assert_true(held);
    close_bench(&b);
}

/* The controller starts anew while the light is switched: at its new zero it stands where it was asked to, by its own
 * account. */
static void a_restart_between_move_and_photograph_is_noticed(void **state)
{
    static bench b;
    open_bench(&b, *state);
    weft_angles zenith = {0, 0};
    bool moved, held;
    assert_int_equal(b.rig.move(b.rig.device, zenith, zenith, &moved, NULL), WEFT_OK);
    fake_stage_arm(&b.fake.stage, FAKE_RESTARTED, 0);
    assert_int_equal(b.light.power(b.light.device, true, NULL), WEFT_OK);
    assert_int_equal(b.fake.stage.injected[FAKE_RESTARTED], 1);
    assert_int_equal(b.rig.held(b.rig.device, &held, NULL), WEFT_OK);
    assert_false(held);
    assert_int_equal(b.rig.move(b.rig.device, zenith, zenith, &moved, NULL), WEFT_OK);
    assert_true(moved && wrong_by(&b, zenith, zenith) < 0.02);
    close_bench(&b);
}

/* ---- Light and shutter ---- */

static void a_lamp_burns_at_its_level_and_goes_off(void **state)
{
    static bench b;
    open_bench(&b, *state);
    assert_int_equal(b.light.power(b.light.device, true, NULL), WEFT_OK);
    assert_int_equal(b.fake.stage.lamp, 0);
    assert_int_equal(b.fake.stage.level, 32768);
    assert_int_equal(b.light.power(b.light.device, false, NULL), WEFT_OK);
    assert_int_equal(b.fake.stage.lamp, -1);
    weft_lamp_switch lamps = weft_controller_lamps(b.controller);
    assert_int_equal(lamps.set(lamps.device, FAKE_LAMPS, 1, NULL), WEFT_SYSTEM);
    assert_int_equal(lamps.set(lamps.device, 2, 1, NULL), WEFT_OK);
    assert_int_equal(b.fake.stage.level, 65535);
    fake_stage *stage = &b.fake.stage;
    weft_controller_free(b.controller);
    b.controller = NULL;
    assert_int_equal(stage->lamp, -1); /* nothing burns on when the program ends */
    close_bench(&b);
}

static void a_shutter_is_released_once_whatever_is_lost(void **state)
{
    static bench b;
    open_bench(&b, *state);
    for (int i = 0; i < 3; i++) {
        fake_stage_arm(&b.fake.stage, (fake_fault[]){FAKE_LOST, FAKE_BROKEN, FAKE_LATE}[i], 0);
        assert_int_equal(weft_controller_pulse(b.controller, 0.05, NULL), WEFT_OK);
        assert_int_equal(b.fake.stage.pulses, i + 1);
    }
    close_bench(&b);
}

/* ---- A whole session ---- */

enum { SIDE = 96, SHOTS = 240, BITS = 12 };

/* A camera that keeps the truth of the stage for each shot. */
typedef struct witness {
    bench *bench;
    double seen[SHOTS][FAKE_AXES];
} witness;

static weft_code expose(void *device, uint64_t frame, double exposure_s, uint16_t *samples, double *read_back_s,
                        weft_error *error)
{
    (void)error;
    witness *w = device;
    for (int axis = 0; axis < FAKE_AXES; axis++)
        w->seen[frame / 256][axis] = fake_stage_truth(&w->bench->fake.stage, axis) + fake_backlash_deg;
    for (int i = 0; i < SIDE * SIDE * 3; i++)
        samples[i] = w->bench->fake.stage.lamp < 0 ? 0 : 3000;
    if (random_below(6) == 0) /* between exposure and the question whether it was kept */
        fake_stage_arm(&w->bench->fake.stage, (fake_fault)(1 + random_below(FAKE_FAULTS - 1)), (int)random_below(6));
    *read_back_s = exposure_s;
    return WEFT_OK;
}

static void write_plan(void)
{
    FILE *file = fopen("plan.csv", "w");
    assert_non_null(file);
    fputs("theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n", file);
    for (int i = 0; i < SHOTS; i++)
        fprintf(file, "%d,%d,%d,%d\n", 5 + 3 * (i % 20), 17 * (i % 20), 10 * (i / 20 % 4), 30 * (i / 20));
    fclose(file);
}

static weft_rig rig_of(bench *b, witness *w)
{
    weft_rig rig = {.name = "bench",
                    .sample = "paper",
                    .identity = "{}",
                    .settings = weft_rig_settings_default(),
                    .camera = {w, expose},
                    .stage = b->rig,
                    .light = b->light};
    rig.settings.width_px = rig.settings.height_px = SIDE;
    rig.settings.focal_length_px = 440;
    rig.settings.camera_half_angle_deg = 0;
    rig.settings.retries = 5;
    rig.calibration = weft_rig_settings_camera(&rig.settings);
    return rig;
}

static void a_session_with_faults_holds_no_wrong_pose(void **state)
{
    static bench b;
    static witness w;
    w = (witness){.bench = &b};
    open_bench(&b, *state);
    write_plan();
    weft_rig rig = rig_of(&b, &w);
    const weft_capture_request request = {.folder = "session", .plan = "plan.csv"};
    weft_capture capture;
    weft_error error = {0};
    assert_int_equal(weft_capture_begin(&request, &rig, NULL, &capture, &error), WEFT_OK);
    if (weft_capture_take(&capture, NULL, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    const weft_session *session = &capture.held[0].session;
    assert_int_equal(session->shot_count, SHOTS);
    int homings = 0;
    for (int i = 0; i < SHOTS; i++) {
        const weft_shot *shot = &session->shot[i];
        const double wanted[FAKE_AXES] = {weft_deg_of_rad(shot->view.theta_rad), weft_deg_of_rad(shot->view.phi_rad),
                                          weft_deg_of_rad(shot->light_driven.theta_rad),
                                          weft_deg_of_rad(shot->light_driven.phi_rad)};
        assert_true(session->record[i].taken);
        for (int axis = 0; axis < FAKE_AXES; axis++)
            assert_true(off_by(w.seen[i][axis], wanted[axis]) < 0.02);
        homings = session->record[i].viewpoint > homings ? session->record[i].viewpoint : homings;
    }
    print_message("%d photographs taken again, %d stays of 12 views\n", capture.summary.disturbed, homings + 1);
    assert_true(capture.summary.disturbed > 0 && homings > 12);
    weft_capture_end(&capture);
    close_bench(&b);
}

/* ---- Two processes: umockdev holds no more than fifty devices that were opened ---- */

static int run_in_a_process(const struct CMUnitTest *tests, size_t count)
{
    pid_t child = fork();
    if (child == 0) {
        int failed = _cmocka_run_group_tests("stage", tests, count, scratch_folder_enter, scratch_folder_leave);
        fflush(NULL);
        _exit(failed != 0);
    }
    int status = 1;
    waitpid(child, &status, 0);
    return status;
}

/* A testbed for each test. */
static int set_up(void **state)
{
    *state = umockdev_testbed_new();
    return 0;
}

static int tear_down(void **state)
{
    if (opened)
        close_bench(opened);
    g_object_unref(*state);
    return 0;
}

#define WITH_TESTBED(test) cmocka_unit_test_setup_teardown(test, set_up, tear_down)

int test_stage_device(void)
{
    const char *preloaded = getenv("LD_PRELOAD");
    if (!preloaded || !strstr(preloaded, "umockdev")) {
        puts("runs under umockdev-wrapper only");
        return 77;
    }
    const struct CMUnitTest one_by_one[] = {
        WITH_TESTBED(lost_and_broken_answers_are_asked_for_again),
        WITH_TESTBED(an_axis_that_stalls_for_good_is_named_and_all_stand_still),
        WITH_TESTBED(a_controller_that_stays_away_is_named),
        WITH_TESTBED(a_serial_number_chooses_among_controllers),
        WITH_TESTBED(a_stop_in_mid_move_halts_the_axes),
        WITH_TESTBED(limits_hold_in_the_host_and_in_the_device),
        WITH_TESTBED(a_push_is_noticed_and_the_next_pose_is_true_again),
        WITH_TESTBED(a_restart_between_move_and_photograph_is_noticed),
        WITH_TESTBED(a_lamp_burns_at_its_level_and_goes_off),
        WITH_TESTBED(a_shutter_is_released_once_whatever_is_lost),
        WITH_TESTBED(a_session_with_faults_holds_no_wrong_pose),
    };
    const struct CMUnitTest many[] = {WITH_TESTBED(faults_in_two_thousand_moves_give_no_wrong_pose)};
    int failed = run_in_a_process(one_by_one, sizeof one_by_one / sizeof *one_by_one);
    return run_in_a_process(many, 1) || failed;
}
