#include "capture/capture.h"
#include "capture/motion/stage.h"
#include "capture/session_check.h"
#include "capture/virtual/virtual_rig.h"
#include "tests/capture/small_session.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* Two cameras on a ring, wrapped so that they count, meet, fail and kill. Views come in pairs that face each other, but
 * for the zenith, which has room for one camera. */

enum { CAMERAS = 2, SHOTS_OF_FIRST = 6, SHOTS_OF_SECOND = 4 };

static const char plan[] = "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n"
                           "20,45,0,0\n50,300,0,0\n"
                           "20,45,30,90\n50,300,30,90\n"
                           "20,45,30,270\n50,300,30,270\n"
                           "20,45,60,20\n60,200,60,20\n"
                           "20,45,60,200\n60,200,60,200\n";

typedef struct bench {
    weft_virtual_rig rig[CAMERAS];
    weft_rig_camera camera[CAMERAS]; /* what the wrappers call */
    weft_rig_light light;
    int lit, exposures[CAMERAS];
    int kill_at;   /* exposure of the second camera in which the process dies; 0: none */
    int fail_from; /* exposure of the second camera from which on it fails; 0: never */
    int fail_to;
    int looks, push_at; /* how often the stage was asked whether it stood still; when it did not, 0: always */
    int stop_at;        /* exposure of the second camera in which somebody presses Ctrl-C; 0: none */
    volatile sig_atomic_t stop;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    int exposing; /* cameras that do so now */
    int met;      /* exposures during which the other camera exposed, too */
} bench;

static bench b;

/* Waits until the other camera exposes, too. Where it never does, the test never ends. */
static void meet(void)
{
    pthread_mutex_lock(&b.mutex);
    b.exposing++;
    pthread_cond_broadcast(&b.changed);
    while (b.exposing < CAMERAS)
        pthread_cond_wait(&b.changed, &b.mutex);
    b.met += b.exposing == CAMERAS;
    pthread_mutex_unlock(&b.mutex);
}

static weft_code expose(int camera, uint64_t frame, double exposure_s, uint16_t *samples, double *read_back_s,
                        weft_error *error)
{
    int number = ++b.exposures[camera];
    if (camera == 1 && number == b.kill_at)
        raise(SIGKILL);
    if (camera == 1 && number == b.stop_at)
        b.stop = 1;
    if (camera == 1 && b.fail_from > 0 && number >= b.fail_from && number < b.fail_to)
        return weft_fail(error, WEFT_SYSTEM, "its cable is out");
    return b.camera[camera].expose(b.camera[camera].device, frame, exposure_s, samples, read_back_s, error);
}

static weft_code expose_first(void *device, uint64_t frame, double exposure_s, uint16_t *samples, double *read_back_s,
                              weft_error *error)
{
    (void)device;
    return expose(0, frame, exposure_s, samples, read_back_s, error);
}

static weft_code expose_second(void *device, uint64_t frame, double exposure_s, uint16_t *samples, double *read_back_s,
                               weft_error *error)
{
    (void)device;
    return expose(1, frame, exposure_s, samples, read_back_s, error);
}

static weft_code power(void *device, bool on, weft_error *error)
{
    (void)device;
    b.lit += on;
    return b.light.power(b.light.device, on, error);
}

static weft_code held(void *device, bool *still, weft_error *error)
{
    (void)device;
    (void)error;
    *still = ++b.looks != b.push_at;
    return WEFT_OK;
}

static virtual_session request;

static void open_patient_bench(int cameras, int retries)
{
    int count;
    b = (bench){.mutex = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER};
    request = small_session_request();
    scratch_store("plan.csv", plan, sizeof plan - 1);
    request.rig.settings.cameras = cameras;
    assert_int_equal(weft_virtual_rigs_open(&request.rig, b.rig, &count, NULL), WEFT_OK);
    assert_int_equal(count, cameras);
    b.light = b.rig[0].rig.light;
    for (int i = 0; i < cameras; i++) {
        b.camera[i] = b.rig[i].rig.camera;
        b.rig[i].rig.camera.expose = i == 0 ? expose_first : expose_second;
        b.rig[i].rig.light.power = power;
        b.rig[i].rig.stage.held = held;
        b.rig[i].rig.settings.retries = retries;
    }
}

/* Whose cameras are asked once. */
static void open_bench(int cameras)
{
    open_patient_bench(cameras, 0);
}

static void close_bench(int cameras)
{
    for (int i = 0; i < cameras; i++)
        weft_virtual_rig_close(&b.rig[i]);
}

static weft_code take(weft_capture_summary *summary, weft_error *error)
{
    weft_capture capture;
    WEFT_TRY(weft_capture_begin(&request.capture, &b.rig[0].rig, NULL, &capture, error));
    weft_code code = weft_capture_take(&capture, &b.stop, NULL, error);
    *summary = capture.summary;
    weft_capture_end(&capture);
    return code;
}

static int taken_by(const char *folder)
{
    weft_session session;
    int taken = 0;
    assert_int_equal(weft_session_open(folder, &session, NULL), WEFT_OK);
    for (int i = 0; i < session.shot_count; i++)
        taken += session.record[i].taken;
    weft_session_free(&session);
    return taken;
}

static int problems_of(const char *folder)
{
    weft_session_problems problems;
    weft_session session;
    assert_int_equal(weft_session_open(folder, &session, NULL), WEFT_OK);
    assert_int_equal(weft_session_check(&session, NULL, &problems, NULL), WEFT_OK);
    int count = problems.count;
    weft_session_problems_free(&problems);
    weft_session_free(&session);
    return count;
}

static int problems_beside(const char *folder)
{
    weft_camera_list list;
    weft_session_problems problems = {0};
    assert_int_equal(weft_camera_list_read(folder, &list, NULL), WEFT_OK);
    assert_int_equal(list.count, CAMERAS);
    assert_int_equal(weft_camera_folder_check(folder, &list, &problems, NULL), WEFT_OK);
    int count = problems.count;
    weft_session_problems_free(&problems);
    return count;
}

static void assert_whole(const char *first, const char *second)
{
    assert_int_equal(taken_by(first), SHOTS_OF_FIRST);
    assert_int_equal(taken_by(second), SHOTS_OF_SECOND);
    assert_int_equal(problems_of(first) + problems_of(second), 0);
}

/* ---- Whole runs ---- */

/* First: a process that has used OpenMP cannot fork and use it again. */
static void a_killed_capture_goes_on(void **state)
{
    (void)state;
    weft_capture_summary summary = {0};
    pid_t child = fork();
    if (child == 0) {
        open_bench(CAMERAS);
        request.capture.folder = "killed";
        b.kill_at = 3;
        take(&summary, NULL);
        _exit(0);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
    open_bench(CAMERAS);
    request.capture.folder = "killed";
    int before = taken_by("killed/camera1") + taken_by("killed/camera2");
    assert_in_range(before, 1, SHOTS_OF_FIRST + SHOTS_OF_SECOND - 1);
    assert_int_equal(take(&summary, NULL), WEFT_OK);
    assert_int_equal(summary.found, before);
    assert_int_equal(summary.taken, SHOTS_OF_FIRST + SHOTS_OF_SECOND - before);
    assert_whole("killed/camera1", "killed/camera2");
    assert_int_equal(problems_beside("killed"), 0);
    close_bench(CAMERAS);
}

static void a_synchronised_shot_is_lit_once_for_all_cameras(void **state)
{
    (void)state;
    weft_capture_summary summary = {0};
    weft_error error = {0};
    open_bench(CAMERAS);
    if (take(&summary, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    assert_int_equal(summary.taken, SHOTS_OF_FIRST + SHOTS_OF_SECOND);
    assert_int_equal(b.lit, SHOTS_OF_FIRST);
    assert_whole("session/camera1", "session/camera2");
    close_bench(CAMERAS);
}

static weft_code expose_and_meet(void *device, uint64_t frame, double exposure_s, uint16_t *samples,
                                 double *read_back_s, weft_error *error)
{
    int camera = device == b.camera[1].device;
    meet();
    weft_code code = b.camera[camera].expose(b.camera[camera].device, frame, exposure_s, samples, read_back_s, error);
    *read_back_s = exposure_s;
    return code;
}

/* One exposure each: the shutter has one time, as where it is set by hand. */
static void cameras_expose_at_the_same_time(void **state)
{
    (void)state;
    const char pair[] = "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n20,45,30,90\n20,45,30,270\n";
    weft_capture_summary summary = {0};
    open_bench(CAMERAS);
    scratch_store("plan.csv", pair, sizeof pair - 1);
    request.capture.folder = "pair";
    for (int i = 0; i < CAMERAS; i++) {
        b.rig[i].rig.camera.expose = expose_and_meet;
        b.rig[i].rig.settings.shortest_exposure_s = b.rig[i].rig.settings.longest_exposure_s = 0.02;
    }
    assert_int_equal(take(&summary, NULL), WEFT_OK);
    assert_int_equal(b.met, CAMERAS);
    close_bench(CAMERAS);
}

static void a_camera_that_fails_loses_nothing_of_the_other(void **state)
{
    (void)state;
    weft_capture_summary summary = {0};
    weft_error error = {0};
    open_bench(CAMERAS);
    request.capture.folder = "failing";
    b.fail_from = 1;
    b.fail_to = 1000;
    assert_int_equal(take(&summary, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "camera 'camera2': its cable is out"));
    assert_int_equal(taken_by("failing/camera1"), SHOTS_OF_FIRST);
    assert_int_equal(taken_by("failing/camera2"), 0);
    assert_int_equal(problems_of("failing/camera1") + problems_of("failing/camera2"), 0);
    /* Three failures in a row, and it is not waited for any more. */
    assert_int_equal(b.exposures[1], 3);
    uint32_t crc = small_session_crc("failing/camera1");
    b.fail_from = 0;
    int exposures = b.exposures[0];
    assert_int_equal(take(&summary, NULL), WEFT_OK);
    assert_int_equal(summary.taken, SHOTS_OF_SECOND);
    assert_int_equal(b.exposures[0], exposures);
    assert_int_equal(small_session_crc("failing/camera1"), crc);
    assert_whole("failing/camera1", "failing/camera2");
    close_bench(CAMERAS);
}

static bool page_says(const char *path, const char *text)
{
    size_t size;
    char *page = (char *)scratch_load(path, &size);
    page[size] = 0;
    bool says = strstr(page, text) != NULL;
    free(page);
    return says;
}

/* Each camera on a page of its own, and both on one. */
static void pages_tell_the_share_of_each_camera(void **state)
{
    (void)state;
    weft_capture_summary summary = {0};
    open_bench(CAMERAS);
    request.capture.folder = "told";
    request.capture.status = "status";
    b.fail_from = 1;
    b.fail_to = 1000;
    assert_int_equal(take(&summary, NULL), WEFT_SYSTEM);
    assert_true(page_says("status/index.html", ">camera1</a></td><td>6 of 6</td>"));
    assert_true(page_says("status/index.html", "has all</td>"));
    assert_true(page_says("status/index.html", ">camera2</a></td><td>0 of 4</td>"));
    assert_true(page_says("status/index.html", "left out: its cable is out"));
    assert_true(page_says("status/index.html", "<b>6 of 10</b>"));
    assert_true(page_says("status/camera1/index.html", "camera camera1"));
    assert_false(page_says("status/camera1/index.html", "ended early"));
    assert_true(page_says("status/camera2/index.html", "ended early: its cable is out"));
    b.fail_from = 0;
    assert_int_equal(take(&summary, NULL), WEFT_OK);
    assert_true(page_says("status/index.html", ">camera2</a></td><td>4 of 4</td>"));
    assert_false(page_says("status/index.html", "left out") || page_says("status/index.html", "ended early"));
    close_bench(CAMERAS);
}

/* In the midst of a synchronised shot: it is completed, and nothing after it is begun. */
static void a_run_that_is_stopped_completes_its_shot_and_says_so(void **state)
{
    (void)state;
    weft_capture_summary summary = {0};
    weft_error error = {0};
    open_bench(CAMERAS);
    request.capture.folder = "stopped";
    request.capture.status = "status";
    b.stop_at = 1;
    assert_int_equal(take(&summary, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "stopped, 4 of 10 photographs"));
    assert_int_equal(taken_by("stopped/camera1"), 3);
    assert_int_equal(taken_by("stopped/camera2"), 1);
    assert_true(page_says("status/index.html", "ended early: it was stopped"));
    assert_true(page_says("status/camera1/index.html", "ended early: it was stopped"));
    b.stop = 0;
    assert_int_equal(take(&summary, NULL), WEFT_OK);
    assert_whole("stopped/camera1", "stopped/camera2");
    close_bench(CAMERAS);
}

/* The sensor of the second camera is not seen; the first takes all. */
static void a_camera_whose_sensor_is_not_seen_is_left_out_alone(void **state)
{
    (void)state;
    weft_capture_summary summary = {0};
    weft_error error = {0};
    open_bench(CAMERAS);
    request.capture.folder = "unseen";
    for (int i = 0; i < CAMERAS; i++)
        b.rig[i].rig.dark_frames = b.rig[i].rig.flat_frames = 1;
    b.fail_from = 2;
    b.fail_to = 3;
    assert_int_equal(take(&summary, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "camera 'camera2': its cable is out"));
    assert_int_equal(taken_by("unseen/camera1"), SHOTS_OF_FIRST);
    assert_int_equal(taken_by("unseen/camera2"), 0);
    b.fail_from = 0;
    assert_int_equal(take(&summary, NULL), WEFT_OK);
    assert_whole("unseen/camera1", "unseen/camera2");
    close_bench(CAMERAS);
}

static void a_camera_that_failed_once_goes_on(void **state)
{
    (void)state;
    weft_capture_summary summary = {0};
    open_bench(CAMERAS);
    request.capture.folder = "once";
    b.fail_from = 1;
    b.fail_to = 2;
    assert_int_equal(take(&summary, NULL), WEFT_SYSTEM);
    assert_int_equal(summary.taken, SHOTS_OF_FIRST + SHOTS_OF_SECOND - 1);
    assert_int_equal(taken_by("once/camera2"), SHOTS_OF_SECOND - 1);
    close_bench(CAMERAS);
}

static int brackets_of(const char *folder, int shots[SHOTS_OF_FIRST])
{
    weft_session session;
    int count = 0;
    assert_int_equal(weft_session_open(folder, &session, NULL), WEFT_OK);
    for (int i = 0; i < session.shot_count; i++) {
        shots[i] = session.record[i].bracket_count;
        count += shots[i];
    }
    weft_session_free(&session);
    return count;
}

/* In whichever photograph of it the stage was pushed, it has all its photographs in the end. */
static void a_bracket_that_the_stage_disturbed_is_taken_again(void **state)
{
    (void)state;
    int shots[3][SHOTS_OF_FIRST] = {{0}};
    for (int push_at = 0; push_at < 3; push_at++) {
        static const char *const folder[] = {"still/camera1", "pushed1/camera1", "pushed2/camera1"};
        static const char *const session[] = {"still", "pushed1", "pushed2"};
        weft_capture_summary summary = {0};
        open_patient_bench(CAMERAS, 1);
        request.capture.folder = session[push_at];
        request.capture.brackets = 2;
        b.push_at = push_at;
        assert_int_equal(take(&summary, NULL), WEFT_OK);
        assert_int_equal(summary.disturbed, push_at > 0);
        assert_true(brackets_of(folder[push_at], shots[push_at]) > 0);
        assert_true(shots[push_at][0] > 0);
        assert_memory_equal(shots[push_at], shots[0], sizeof shots[0]);
        close_bench(CAMERAS);
    }
}

/* ---- The folder ---- */

static void what_is_no_session_of_a_camera_is_unexpected(void **state)
{
    (void)state;
    assert_int_equal(problems_beside("session"), 0);
    scratch_store("session/notes.txt", "x", 1);
    scratch_store("session/.cameras.99.json", "x", 1);
    assert_int_equal(problems_beside("session"), 2);
    unlink("session/notes.txt");
    unlink("session/.cameras.99.json");
}

static void other_cameras_do_not_go_on(void **state)
{
    (void)state;
    weft_capture_summary summary = {0};
    weft_error error = {0};
    open_bench(CAMERAS);
    snprintf(b.rig[1].camera_name, sizeof b.rig[1].camera_name, "other");
    assert_int_equal(take(&summary, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "begun with other cameras"));
    close_bench(CAMERAS);
    open_bench(1);
    assert_int_equal(take(&summary, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "neither empty nor a session"));
    close_bench(1);
}

/* ---- A stage with two cameras ---- */

static int asked;

static weft_code turn(void *context, const char *text, weft_error *error)
{
    (void)context;
    (void)text;
    (void)error;
    asked++;
    return WEFT_OK;
}

static weft_shot shot_of(double theta_deg, double phi_deg)
{
    weft_angles view = {weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)}, light = {weft_rad_of_deg(40), 0};
    return (weft_shot){light, view, light};
}

/* A turntable under two cameras, at theta 30, phi 0 and at theta 60, phi 90. Turned by -10 degrees, the first sees the
 * sample from phi 10, the second from phi 100. */
static void cameras_share_the_pose_of_a_turntable(void **state)
{
    (void)state;
    const weft_angles lamp = {weft_rad_of_deg(40), 0};
    weft_axes first = {.count = 1,
                       .axis = {{.name = "table",
                                 .moves = WEFT_BODY_SAMPLE,
                                 .angle = WEFT_TURN_PHI,
                                 .low_deg = -180,
                                 .high_deg = 180,
                                 .by_hand = true}},
                       .lamps = true};
    weft_axes second = first;
    first.fixed_deg[WEFT_BODY_CAMERA][WEFT_TURN_THETA] = 30;
    second.fixed_deg[WEFT_BODY_CAMERA][WEFT_TURN_THETA] = 60;
    second.fixed_deg[WEFT_BODY_CAMERA][WEFT_TURN_PHI] = 90;
    const weft_stage_parts parts = {
        .axes = &first, .lamp = &lamp, .lamp_count = 1, .lamp_tolerance_rad = 4, .rig_operator = {NULL, turn}};
    weft_stage *stage, *beside;
    assert_int_equal(weft_stage_create(&parts, &stage, NULL), WEFT_OK);
    assert_int_equal(weft_stage_create_beside(stage, &second, &beside, NULL), WEFT_OK);
    weft_rig_stage a = weft_stage_for_rig(stage), c = weft_stage_for_rig(beside);

    weft_shot seen = shot_of(30, 10), together = shot_of(60, 100), apart = shot_of(60, 101);
    weft_place at, same, other;
    weft_angles view;
    assert_int_equal(a.place(a.device, &seen, &at, NULL), WEFT_OK);
    assert_int_equal(c.place(c.device, &together, &same, NULL), WEFT_OK);
    assert_int_equal(c.place(c.device, &apart, &other, NULL), WEFT_OK);
    for (int i = 0; i < WEFT_PLACE_NUMBERS; i++)
        assert_true(fabs(at.at[i] - same.at[i]) < 1e-9);
    assert_true(fabs(at.at[0] - other.at[0]) > 0.5);
    assert_int_equal(a.place(a.device, &together, &at, NULL), WEFT_BAD_INPUT);
    assert_int_equal(c.view_of(c.device, a.device, &seen, &view, NULL), WEFT_OK);
    assert_true(fabs(weft_deg_of_rad(view.theta_rad) - 60) < 1e-9 && fabs(weft_deg_of_rad(view.phi_rad) - 100) < 1e-9);

    bool moved;
    assert_int_equal(a.home(a.device, 0, NULL), WEFT_OK);
    assert_int_equal(c.home(c.device, 0, NULL), WEFT_OK);
    assert_int_equal(a.move(a.device, seen.view, seen.light, &moved, NULL), WEFT_OK);
    assert_true(moved && asked == 1);
    assert_int_equal(c.move(c.device, together.view, seen.light, &moved, NULL), WEFT_OK);
    assert_true(moved && asked == 1);
    assert_int_equal(c.move(c.device, together.view, seen.light, &moved, NULL), WEFT_OK);
    assert_false(moved);
    assert_int_equal(c.move(c.device, apart.view, seen.light, &moved, NULL), WEFT_OK);
    assert_true(moved && asked == 2);
    assert_int_equal(a.move(a.device, shot_of(30, 11).view, seen.light, &moved, NULL), WEFT_OK);
    assert_true(moved && asked == 2);
    weft_stage_free(beside);
    weft_stage_free(stage);
}

int test_synchronised_shots(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_killed_capture_goes_on),
        cmocka_unit_test(a_synchronised_shot_is_lit_once_for_all_cameras),
        cmocka_unit_test(what_is_no_session_of_a_camera_is_unexpected),
        cmocka_unit_test(other_cameras_do_not_go_on),
        cmocka_unit_test(cameras_expose_at_the_same_time),
        cmocka_unit_test(a_camera_that_fails_loses_nothing_of_the_other),
        cmocka_unit_test(pages_tell_the_share_of_each_camera),
        cmocka_unit_test(a_run_that_is_stopped_completes_its_shot_and_says_so),
        cmocka_unit_test(a_camera_whose_sensor_is_not_seen_is_left_out_alone),
        cmocka_unit_test(a_camera_that_failed_once_goes_on),
        cmocka_unit_test(a_bracket_that_the_stage_disturbed_is_taken_again),
        cmocka_unit_test(cameras_share_the_pose_of_a_turntable),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
