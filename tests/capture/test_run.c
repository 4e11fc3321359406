#include "base/picture/image.h"
#include "tests/capture/small_session.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <fcntl.h>
#include <limits.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static void remove_session(void)
{
    assert_int_equal(system("rm -rf session session.truth.h5"), 0);
}

static weft_code run(const virtual_session *request, weft_capture_summary *summary, weft_error *error)
{
    *error = (weft_error){0};
    return virtual_session_take(request, NULL, NULL, summary, error);
}

/* The time of day, which some image libraries write into a file. They find this function before that of the system. */
static time_t time_of_day = 1700000000;

__attribute__((visibility("default"))) time_t time(time_t *now)
{
    if (now)
        *now = time_of_day;
    return time_of_day;
}

static uint32_t crc_of_run(uint64_t seed, int threads)
{
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error;
    request.rig.seed = seed;
    omp_set_num_threads(threads);
    assert_int_equal(run(&request, &summary, &error), WEFT_OK);
    omp_set_num_threads(2);
    small_session_assert_whole("session");
    uint32_t crc = small_session_crc("session");
    remove_session();
    return crc;
}

static void a_seed_gives_the_same_bytes_for_any_number_of_threads(void **state)
{
    (void)state;
    uint32_t crc = crc_of_run(1, 1);
    time_of_day += 86400;
    assert_int_equal(crc_of_run(1, 3), crc);
    assert_int_not_equal(crc_of_run(2, 1), crc);
}

/* The largest raw value in the white patches, drawn in by a third. */
static int brightest_white(const virtual_session *request, const weft_session *session, int shot)
{
    uint16_t *samples = malloc(SMALL_SIZE * SMALL_SIZE * 3 * sizeof *samples);
    char path[PATH_MAX];
    weft_session_photograph_path(session, shot, path, sizeof path);
    assert_non_null(samples);
    assert_int_equal(weft_photograph_read(path, SMALL_SIZE, SMALL_SIZE, session->bits, samples, NULL), WEFT_OK);
    weft_virtual_world world = weft_virtual_world_of_camera(&request->rig.settings, request->rig.seed, 0);
    weft_pose pose = weft_virtual_world_pose(&world, session->shot[shot].view, session->record[shot].viewpoint);
    weft_homography homography = weft_homography_of_pose(&world.camera, &pose);
    int brightest = 0;
    for (int i = 0; i < WEFT_TARGET_REFERENCE_COUNT * 9; i++) {
        weft_rectangle r = weft_target_reference(&session->target, i / 9);
        double u = (i % 3 + 1) / 4.0, v = (i / 3 % 3 + 1) / 4.0;
        weft_pixel at = weft_camera_distort(
            &world.camera, weft_homography_apply(&homography, r.x0 + u * (r.x1 - r.x0), r.y0 + v * (r.y1 - r.y0)));
        int value = samples[3 * (lround(at.y) * SMALL_SIZE + lround(at.x))];
        brightest = value > brightest ? value : brightest;
    }
    free(samples);
    return brightest;
}

static void exposures_stay_within_limits_and_white_patches_below_saturation(void **state)
{
    (void)state;
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error;
    weft_session session;
    assert_int_equal(run(&request, &summary, &error), WEFT_OK);
    assert_int_equal(summary.taken, SMALL_SHOTS);
    assert_true(summary.exposures >= SMALL_SHOTS);
    assert_int_equal(weft_session_open("session", &session, NULL), WEFT_OK);
    int used = 0;
    for (int shot = 0; shot < SMALL_SHOTS; shot++) {
        double exposure_s = session.record[shot].exposure_s;
        assert_true(exposure_s >= request.rig.settings.rig.shortest_exposure_s - 1e-6 &&
                    exposure_s <= request.rig.settings.rig.longest_exposure_s);
        int white = brightest_white(&request, &session, shot);
        assert_true(white < 4095);
        used += white > 0.6 * 4095;
    }
    /* Where no highlight rules, the white patches use the range of the sensor. */
    assert_true(used > SMALL_SHOTS / 3);
    weft_session_free(&session);
    remove_session();
}

static void exposures_that_time_out_are_repeated(void **state)
{
    (void)state;
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error;
    request.rig.settings.timeout_probability = 0.3;
    request.rig.settings.rig.retries = 20;
    assert_int_equal(run(&request, &summary, &error), WEFT_OK);
    assert_true(summary.timeouts > 0);
    small_session_assert_whole("session");
    remove_session();
}

static void a_camera_that_never_delivers_ends_the_run_with_its_message(void **state)
{
    (void)state;
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error;
    request.rig.settings.timeout_probability = 0.9;
    request.rig.settings.rig.retries = 1;
    assert_int_equal(run(&request, &summary, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "timed out"));
    assert_int_equal(small_session_journal_lines("session"), summary.taken);
    remove_session();
}

static void a_full_disk_ends_the_run_cleanly_and_it_goes_on_later(void **state)
{
    (void)state;
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error;
    scratch_limit_file_size(20000);
    weft_code code = run(&request, &summary, &error);
    scratch_limit_file_size(0);
    assert_int_equal(code, WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "session"));
    assert_int_equal(small_session_journal_lines("session"), 0);
    assert_int_not_equal(access("session/.photograph.tif", F_OK), 0);
    assert_int_equal(run(&request, &summary, &error), WEFT_OK);
    small_session_assert_whole("session");
    remove_session();
}

static void a_disk_that_fills_under_the_truth_leaves_no_half_file(void **state)
{
    (void)state;
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error;
    request.truth.size = 64;
    scratch_limit_file_size(50000);
    weft_code code = run(&request, &summary, &error);
    scratch_limit_file_size(0);
    assert_int_equal(code, WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "session.truth.h5"));
    assert_int_not_equal(access("session.truth.h5", F_OK), 0);
    assert_int_equal(scratch_folder_entries(), 2); /* plan.csv, session */
    assert_int_equal(run(&request, &summary, &error), WEFT_OK);
    assert_int_equal(summary.taken, 0);
    remove_session();
}

static void a_place_where_the_truth_cannot_go_is_named_before_the_first_photograph(void **state)
{
    (void)state;
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error;
    request.truth.path = "absent/truth.h5";
    assert_int_equal(run(&request, &summary, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "absent"));
    assert_int_equal(summary.taken, 0);
    remove_session();
}

static void a_sample_file_whose_name_is_not_utf_8_is_photographed(void **state)
{
    (void)state;
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error;
    assert_int_equal(symlink(request.rig.sample, "soi\xe9.wv"), 0);
    request.rig.sample = "soi\xe9.wv";
    assert_int_equal(run(&request, &summary, &error), WEFT_OK);
    assert_int_equal(run(&request, &summary, &error), WEFT_OK);
    assert_int_equal(summary.found, SMALL_SHOTS);
    assert_int_equal(unlink("soi\xe9.wv"), 0);
    remove_session();
}

static volatile sig_atomic_t stop;

static void stop_after_seven(void *context, const char *stage, long done, long total)
{
    (void)context;
    (void)stage;
    (void)total;
    stop = done >= 7;
}

static void a_stop_completes_the_shot_in_flight_and_the_next_run_goes_on(void **state)
{
    (void)state;
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error = {0};
    weft_progress progress = {stop_after_seven, NULL};
    stop = 0;
    assert_int_equal(virtual_session_take(&request, &stop, &progress, &summary, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "stopped, 7 of 25 photographs"));
    assert_int_equal(run(&request, &summary, &error), WEFT_OK);
    assert_int_equal(summary.found, 7);
    assert_int_equal(summary.taken, SMALL_SHOTS - 7);
    small_session_assert_whole("session");
    remove_session();
}

static void another_seed_sample_rig_or_plan_does_not_continue_a_session(void **state)
{
    (void)state;
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error;
    assert_int_equal(run(&request, &summary, &error), WEFT_OK);
    uint32_t crc = small_session_crc("session");
    virtual_session other = request;
    other.rig.seed = 2;
    assert_int_equal(run(&other, &summary, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "seed"));
    other = request;
    other.rig.sample = WEFT_ASSETS "/weaves/wool_gabardine.wv";
    assert_int_equal(run(&other, &summary, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "sample"));
    other = request;
    other.rig.settings.aperture_mm = 3;
    assert_int_equal(run(&other, &summary, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "aperture_mm"));
    other = request;
    other.capture.plan = "ubo81";
    assert_int_equal(run(&other, &summary, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "plan"));
    assert_int_equal(small_session_crc("session"), crc);
    remove_session();
}

static void a_folder_that_holds_other_files_is_left_alone(void **state)
{
    (void)state;
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error;
    assert_int_equal(mkdir("session", 0777), 0);
    scratch_store("session/letter.txt", "dear", 4);
    assert_int_equal(run(&request, &summary, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "neither empty nor a session"));
    assert_int_not_equal(access("session/session.json", F_OK), 0);
    remove_session();
}

static void two_captures_cannot_share_a_session(void **state)
{
    (void)state;
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error;
    assert_int_equal(mkdir("session", 0777), 0);
    int lock = open("session/.lock", O_RDWR | O_CREAT, 0666);
    assert_true(lock >= 0);
    assert_int_equal(flock(lock, LOCK_EX | LOCK_NB), 0);
    assert_int_equal(run(&request, &summary, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "another process"));
    close(lock);
    assert_int_equal(run(&request, &summary, &error), WEFT_OK);
    remove_session();
}

static void a_rehearsal_counts_and_writes_nothing(void **state)
{
    (void)state;
    virtual_session request = small_session_request();
    weft_capture_rehearsal rehearsal;
    assert_int_equal(virtual_session_rehearse(&request, &rehearsal, NULL), WEFT_OK);
    assert_int_equal(rehearsal.shot_count, SMALL_SHOTS);
    assert_int_equal(rehearsal.view_count, 5);
    assert_int_equal(rehearsal.driven_aside, 5);
    assert_true(rehearsal.bytes >= SMALL_SHOTS * SMALL_SIZE * SMALL_SIZE * 3 * 12 / 8);
    assert_true(rehearsal.seconds_per_photograph > 0);
    weft_capture_rehearsal_free(&rehearsal);
    assert_int_equal(scratch_folder_entries(), 1); /* plan.csv */
}

int test_run(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_seed_gives_the_same_bytes_for_any_number_of_threads),
        cmocka_unit_test(exposures_stay_within_limits_and_white_patches_below_saturation),
        cmocka_unit_test(exposures_that_time_out_are_repeated),
        cmocka_unit_test(a_camera_that_never_delivers_ends_the_run_with_its_message),
        cmocka_unit_test(a_full_disk_ends_the_run_cleanly_and_it_goes_on_later),
        cmocka_unit_test(a_disk_that_fills_under_the_truth_leaves_no_half_file),
        cmocka_unit_test(a_place_where_the_truth_cannot_go_is_named_before_the_first_photograph),
        cmocka_unit_test(a_sample_file_whose_name_is_not_utf_8_is_photographed),
        cmocka_unit_test(a_stop_completes_the_shot_in_flight_and_the_next_run_goes_on),
        cmocka_unit_test(another_seed_sample_rig_or_plan_does_not_continue_a_session),
        cmocka_unit_test(a_folder_that_holds_other_files_is_left_alone),
        cmocka_unit_test(two_captures_cannot_share_a_session),
        cmocka_unit_test(a_rehearsal_counts_and_writes_nothing),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
