#include "capture/shooting.h"

#include "base/picture/image.h"
#include "capture/session_check.h"
#include "tests/capture/small_session.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { DARK = 2, FLAT = 3, FRAMES = 2 * DARK + FLAT };

static virtual_session request_with_frames(void)
{
    virtual_session request = small_session_request();
    request.rig.settings.sensor_faults = 1;
    request.rig.settings.dark_frames = DARK;
    request.rig.settings.flat_frames = FLAT;
    return request;
}

static weft_code run(const virtual_session *request, const volatile sig_atomic_t *stop, const weft_progress *progress,
                     weft_error *error)
{
    weft_capture_summary summary;
    *error = (weft_error){0};
    return virtual_session_take(request, stop, progress, &summary, error);
}

static void remove_session(void)
{
    assert_int_equal(system("rm -rf session session.truth.h5"), 0);
}

static int count_faults(const char *folder)
{
    weft_session session;
    weft_session_problems faults;
    assert_int_equal(weft_session_open(folder, &session, NULL), WEFT_OK);
    assert_int_equal(weft_session_check(&session, NULL, &faults, NULL), WEFT_OK);
    int count = faults.count;
    weft_session_problems_free(&faults);
    weft_session_free(&session);
    return count;
}

/* Raw values above black, in the mean over a frame. */
static double mean_of(const weft_session *session, int frame)
{
    static uint16_t samples[SMALL_SIZE * SMALL_SIZE * 3];
    char path[PATH_MAX];
    double sum = 0;
    weft_session_frame_path(session, frame, path, sizeof path);
    assert_int_equal(weft_photograph_read(path, SMALL_SIZE, SMALL_SIZE, session->bits, samples, NULL), WEFT_OK);
    for (int i = 0; i < SMALL_SIZE * SMALL_SIZE * 3; i++)
        sum += samples[i] - session->black_level;
    return sum / (SMALL_SIZE * SMALL_SIZE * 3);
}

static void a_session_begins_with_them(void **state)
{
    (void)state;
    virtual_session request = request_with_frames();
    const weft_virtual_settings *s = &request.rig.settings;
    weft_session session;
    weft_error error;
    assert_int_equal(run(&request, NULL, NULL, &error), WEFT_OK);
    assert_int_equal(count_faults("session"), 0);
    assert_int_equal(weft_session_open("session", &session, NULL), WEFT_OK);
    assert_int_equal(weft_session_frame_count(&session), FRAMES);
    assert_int_equal(weft_sensor_frames_missing(&session), 0);
    double per_second = s->dark_electrons / s->full_well_electrons * (4095 - 64);
    assert_true(fabs(session.frame[0].exposure_s / s->rig.shortest_exposure_s - 1) < 0.01);
    assert_true(session.frame[DARK].exposure_s == s->rig.longest_exposure_s);
    assert_true(fabs(mean_of(&session, 0)) < 0.1);
    assert_true(fabs(mean_of(&session, DARK) / (per_second * s->rig.longest_exposure_s) - 1) < 0.05);
    for (int i = 2 * DARK; i < FRAMES; i++)
        assert_in_range((int)mean_of(&session, i), 4031 * 0.5, 4031 * 0.8);
    weft_session_free(&session);
    remove_session();
}

static volatile sig_atomic_t stop;

static void stop_after_five(void *context, const char *stage, long done, long total)
{
    (void)context;
    (void)total;
    stop = strcmp(stage, "looking at the sensor") == 0 && done >= 5;
}

static void what_is_missing_or_damaged_is_taken_the_next_time(void **state)
{
    (void)state;
    virtual_session request = request_with_frames();
    const weft_progress progress = {stop_after_five, NULL};
    weft_error error;
    stop = 0;
    assert_int_equal(run(&request, &stop, &progress, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "stopped, 0 of 25"));
    assert_int_equal(access("session/sensor/flat_001.tif", F_OK), 0);
    assert_int_not_equal(access("session/sensor/flat_002.tif", F_OK), 0);
    assert_int_equal(run(&request, NULL, NULL, &error), WEFT_OK);
    assert_int_equal(count_faults("session"), 0);

    assert_int_equal(remove("session/sensor/dark_long_002.tif"), 0);
    scratch_store("session/sensor/flat_003.tif", "torn", 4);
    scratch_store("session/sensor/flat_004.tif", "more", 4);
    assert_int_equal(count_faults("session"), 3);
    assert_int_equal(run(&request, NULL, NULL, &error), WEFT_OK);
    assert_int_equal(count_faults("session"), 1); /* the unexpected one stays */
    assert_int_equal(remove("session/sensor/flat_004.tif"), 0);
    assert_int_equal(count_faults("session"), 0);

    request.rig.settings.dark_frames = DARK + 1;
    assert_int_equal(run(&request, NULL, NULL, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "dark_frames"));
    remove_session();
}

static void a_frame_that_the_camera_does_not_deliver_is_asked_for_again(void **state)
{
    (void)state;
    virtual_session request = request_with_frames();
    weft_error error;
    request.rig.settings.timeout_probability = 0.9;
    request.rig.settings.rig.retries = 0;
    assert_int_equal(run(&request, NULL, NULL, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "timed out"));
    request.rig.settings.timeout_probability = 0.3;
    request.rig.settings.rig.retries = 20;
    remove_session();
    assert_int_equal(run(&request, NULL, NULL, &error), WEFT_OK);
    assert_int_equal(count_faults("session"), 0);
    remove_session();
}

int test_sensor_frames(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_session_begins_with_them),
        cmocka_unit_test(what_is_missing_or_damaged_is_taken_the_next_time),
        cmocka_unit_test(a_frame_that_the_camera_does_not_deliver_is_asked_for_again),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
