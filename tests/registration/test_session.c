#include "registration/registration.h"

#include "base/picture/image.h"
#include "btf/dataset/dataset.h"
#include "plate_session.h"
#include "registration/outcome/outcome.h"
#include "tests/registration/near.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TEXELS = 16 };

static weft_session session;
static weft_registration registration;
static weft_error error;
static weft_half samples[TEXELS][TEXELS][PLATE_SESSION_SHOTS][3];
static uint8_t mask[TEXELS][TEXELS][PLATE_SESSION_SHOTS];

static weft_code run(const char *folder, bool allow_unfinished, const char *report)
{
    error = (weft_error){0};
    assert_int_equal(weft_session_open(folder, &session, &error), WEFT_OK);
    weft_registration_settings settings = weft_registration_defaults(&session);
    settings.width = settings.height = TEXELS;
    settings.allow_unfinished = allow_unfinished;
    settings.report_folder = report;
    weft_code code = weft_register_session(&session, "made.btf.h5", &settings, NULL, &registration, &error);
    if (code != WEFT_OK)
        weft_session_free(&session);
    return code;
}

static void finish(void)
{
    weft_registration_free(&registration);
    weft_session_free(&session);
    unlink("made.btf.h5");
}

static void read_dataset(void)
{
    weft_dataset *dataset;
    assert_int_equal(weft_dataset_open("made.btf.h5", &dataset, &error), WEFT_OK);
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    assert_int_equal(layout->image_count, PLATE_SESSION_SHOTS);
    assert_int_equal(layout->view_count, PLATE_SESSION_VIEWS);
    assert_int_equal(layout->values, WEFT_REFLECTANCE_COSINE);
    assert_near((double)layout->texel_pitch_mm, 2, 1e-9);
    assert_non_null(strstr(layout->provenance, "standard_error_texels"));
    assert_non_null(strstr(layout->provenance, "\"white_level\":["));
    assert_int_equal(
        weft_dataset_read_block(dataset, 0, 0, TEXELS, TEXELS, &samples[0][0][0][0], &mask[0][0][0], &error), WEFT_OK);
    weft_dataset_close(dataset);
}

static bool all_masked(int shot, int bits)
{
    for (int i = 0; i < TEXELS * TEXELS; i++) {
        if (mask[i / TEXELS][i % TEXELS][shot] != bits)
            return false;
    }
    return true;
}

/* All texels of the frontal view are there; of the others those beside the frame may be missing. */
static bool is_registered(int shot)
{
    for (int i = 0; i < TEXELS * TEXELS; i++) {
        int x = i % TEXELS, y = i / TEXELS, bits = mask[y][x][shot];
        bool is_beside = x == 0 || y == 0 || x == TEXELS - 1 || y == TEXELS - 1;
        bool may_lack = is_beside && shot >= PLATE_SESSION_LIGHTS;
        if (bits != 0 && !(may_lack && bits == WEFT_MASK_MISSING))
            return false;
    }
    return true;
}

/* Largest relative error of a shot against the diffuser's reflectance times the cosine. */
static double worst_error(int shot)
{
    double truth = PLATE_SESSION_SAMPLE * cos((double)session.shot[shot].light.theta_rad), worst = 0;
    for (int i = 0; i < TEXELS * TEXELS; i++) {
        for (int c = 0; c < 3 && mask[i / TEXELS][i % TEXELS][shot] == 0; c++)
            worst = fmax(worst, fabs((double)weft_float_of_half(samples[i / TEXELS][i % TEXELS][shot][c]) / truth - 1));
    }
    return worst;
}

static void a_diffuser_comes_out_as_its_reflectance_times_the_cosine(void **state)
{
    (void)state;
    plate_session_write("good", &plate_no_faults);
    assert_int_equal(run("good", false, NULL), WEFT_OK);
    read_dataset();
    assert_int_equal(registration.image_count, PLATE_SESSION_SHOTS);
    assert_int_equal(registration.fault_count, 0);
    for (int shot = 0; shot < PLATE_SESSION_SHOTS; shot++) {
        assert_true(is_registered(shot));
        assert_true(worst_error(shot) < 0.03);
    }
    finish();
}

static void bad_photographs_are_named_and_masked_and_the_rest_goes_on(void **state)
{
    (void)state;
    char path[4][512];
    const int bad[4] = {0, 4, 5, 7};
    plate_session_write("bad", &plate_no_faults);
    for (int i = 0; i < 4; i++)
        plate_session_photograph("bad", bad[i], path[i]);
    assert_int_equal(unlink(path[0]), 0);
    assert_int_equal(truncate(path[1], 20000), 0);
    uint16_t *other = calloc(PLATE_SESSION_SIZE * PLATE_SESSION_SIZE * 3, sizeof *other);
    assert_int_equal(weft_photograph_write(path[2], 100, 90, 12, other, NULL), WEFT_OK);
    for (int i = 0; i < PLATE_SESSION_SIZE * PLATE_SESSION_SIZE * 3; i++)
        other[i] = 64;
    assert_int_equal(weft_photograph_write(path[3], PLATE_SESSION_SIZE, PLATE_SESSION_SIZE, 12, other, NULL), WEFT_OK);
    free(other);
    assert_int_equal(run("bad", false, NULL), WEFT_OK);
    read_dataset();
    assert_int_equal(registration.fault_count, 4);
    for (int i = 0; i < 4; i++) {
        assert_non_null(strstr(registration.fault[bad[i]].reason, strrchr(path[i], '/') + 1));
        assert_true(all_masked(bad[i], WEFT_MASK_MISSING));
    }
    assert_true(is_registered(1) && worst_error(1) < 0.03);
    assert_true(is_registered(8) && worst_error(8) < 0.03);
    finish();
}

static void a_view_with_a_covered_target_fails_alone(void **state)
{
    (void)state;
    const plate_faults faults = {1, -1, -1};
    plate_session_write("covered", &faults);
    assert_int_equal(run("covered", false, NULL), WEFT_OK);
    read_dataset();
    assert_int_equal(registration.failed_viewpoints, 1);
    assert_int_equal(registration.pose[1].source, WEFT_POSE_FAILED);
    for (int shot = 0; shot < PLATE_SESSION_SHOTS; shot++)
        assert_true(shot / PLATE_SESSION_LIGHTS == 1 ? all_masked(shot, WEFT_MASK_MISSING) : is_registered(shot));
    finish();
}

static void saturated_white_patches_are_replaced_by_the_light_of_other_photographs(void **state)
{
    (void)state;
    const plate_faults faults = {-1, -1, 3};
    plate_session_write("bright", &faults);
    assert_int_equal(run("bright", false, NULL), WEFT_OK);
    read_dataset();
    assert_int_equal(registration.estimated_whites, 1);
    assert_int_equal(registration.white[3].patches, 0);
    assert_true(is_registered(3) && worst_error(3) < 0.04);
    finish();
}

/* Sets one channel of a photograph to the black level. */
static void darken_blue(const char *folder, int shot)
{
    char path[512];
    const size_t pixels = (size_t)PLATE_SESSION_SIZE * PLATE_SESSION_SIZE;
    uint16_t *raw = malloc(3 * pixels * sizeof *raw);
    assert_non_null(raw);
    plate_session_photograph(folder, shot, path);
    assert_int_equal(weft_photograph_read(path, PLATE_SESSION_SIZE, PLATE_SESSION_SIZE, 12, raw, NULL), WEFT_OK);
    for (size_t i = 0; i < pixels; i++)
        raw[3 * i + 2] = 64;
    assert_int_equal(weft_photograph_write(path, PLATE_SESSION_SIZE, PLATE_SESSION_SIZE, 12, raw, NULL), WEFT_OK);
    free(raw);
}

static void a_photograph_without_light_in_a_channel_does_not_sink_the_rest(void **state)
{
    (void)state;
    plate_session_write("red", &plate_no_faults);
    darken_blue("red", 4);
    assert_int_equal(run("red", false, NULL), WEFT_OK);
    read_dataset();
    assert_int_equal(registration.estimated_whites, 1);
    assert_int_equal(registration.white[4].patches, 0);
    assert_int_equal(registration.image_count, PLATE_SESSION_SHOTS);
    assert_true(is_registered(3) && worst_error(3) < 0.03);
    finish();
}

/* Raw values above black times `gain`. */
static void dim(const char *folder, int shot, double gain)
{
    char path[512];
    const size_t values = (size_t)PLATE_SESSION_SIZE * PLATE_SESSION_SIZE * 3;
    uint16_t *raw = malloc(values * sizeof *raw);
    assert_non_null(raw);
    plate_session_photograph(folder, shot, path);
    assert_int_equal(weft_photograph_read(path, PLATE_SESSION_SIZE, PLATE_SESSION_SIZE, 12, raw, NULL), WEFT_OK);
    for (size_t i = 0; i < values; i++)
        raw[i] = (uint16_t)(64 + fmax(0, gain * (raw[i] - 64)) + 0.5);
    assert_int_equal(weft_photograph_write(path, PLATE_SESSION_SIZE, PLATE_SESSION_SIZE, 12, raw, NULL), WEFT_OK);
    free(raw);
}

/* A lamp that ages: reflectance knows nothing of it, the record does. */
static void a_lamp_that_drifts_is_taken_out_and_told(void **state)
{
    (void)state;
    plate_session_write("aged", &plate_no_faults);
    for (int shot = 6; shot < 9; shot++)
        dim("aged", shot, 0.9);
    assert_int_equal(run("aged", false, NULL), WEFT_OK);
    read_dataset();
    double first = weft_viewpoint_white_of(&registration, 0).level[1],
           last = weft_viewpoint_white_of(&registration, 2).level[1];
    weft_lamp_drift drift = weft_lamp_drift_of(&registration);
    assert_int_equal(drift.viewpoints, PLATE_SESSION_VIEWS);
    assert_true(fabs(first / registration.white[0].level[1] - 1) < 0.02);
    assert_true(fabs(last / first - 0.9) < 0.01);
    /* Against the mean of 1, 1 and 0.9. */
    assert_true(fabs(drift.lowest - (0.9 * 3 / 2.9 - 1)) < 0.01 && fabs(drift.highest - (3 / 2.9 - 1)) < 0.01);
    for (int shot = 0; shot < PLATE_SESSION_SHOTS; shot++)
        assert_true(is_registered(shot) && worst_error(shot) < 0.03);
    finish();
}

static void an_unfinished_session_is_registered_only_when_allowed(void **state)
{
    (void)state;
    const plate_faults faults = {-1, 6, -1};
    plate_session_write("unfinished", &faults);
    assert_int_equal(run("unfinished", false, NULL), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "1 of 9"));
    assert_int_equal(run("unfinished", true, NULL), WEFT_OK);
    read_dataset();
    assert_true(all_masked(6, WEFT_MASK_MISSING));
    assert_true(is_registered(7));
    finish();
}

static void when_nothing_can_be_used_the_command_fails_and_leaves_no_file(void **state)
{
    (void)state;
    char path[512];
    plate_session_write("empty", &plate_no_faults);
    for (int shot = 0; shot < PLATE_SESSION_SHOTS; shot++) {
        plate_session_photograph("empty", shot, path);
        assert_int_equal(unlink(path), 0);
    }
    int before = scratch_folder_entries();
    assert_int_equal(run("empty", false, NULL), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "'empty'"));
    assert_int_equal(scratch_folder_entries(), before);
}

static void a_session_without_photographs_is_refused(void **state)
{
    (void)state;
    plate_session_write("none", &plate_no_faults);
    scratch_store("none/journal.jsonl", "", 0);
    assert_int_equal(run("none", true, NULL), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "no photograph"));
}

static void a_full_disk_leaves_nothing_behind(void **state)
{
    (void)state;
    int before = scratch_folder_entries();
    scratch_limit_file_size(5000);
    weft_code code = run("good", false, NULL);
    scratch_limit_file_size(0);
    assert_int_equal(code, WEFT_SYSTEM);
    assert_int_equal(scratch_folder_entries(), before);
}

static void the_report_names_every_view_and_shows_it(void **state)
{
    (void)state;
    size_t size;
    assert_int_equal(run("covered", false, "report"), WEFT_OK);
    char *page = (char *)scratch_load("report/index.html", &size);
    page = realloc(page, size + 1);
    assert_non_null(page);
    page[size] = 0;
    assert_non_null(strstr(page, "tv063_pv229"));
    assert_non_null(strstr(page, "What they cannot determine"));
    assert_non_null(strstr(page, "the target is not visible"));
    assert_int_equal(access("report/pictures/000_photograph.png", R_OK), 0);
    assert_int_equal(access("report/pictures/000_texels.png", R_OK), 0);
    assert_int_equal(access("report/pictures/001_photograph.png", R_OK), 0);
    free(page);
    finish();
}

int test_session(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_diffuser_comes_out_as_its_reflectance_times_the_cosine),
        cmocka_unit_test(bad_photographs_are_named_and_masked_and_the_rest_goes_on),
        cmocka_unit_test(a_view_with_a_covered_target_fails_alone),
        cmocka_unit_test(saturated_white_patches_are_replaced_by_the_light_of_other_photographs),
        cmocka_unit_test(a_photograph_without_light_in_a_channel_does_not_sink_the_rest),
        cmocka_unit_test(a_lamp_that_drifts_is_taken_out_and_told),
        cmocka_unit_test(an_unfinished_session_is_registered_only_when_allowed),
        cmocka_unit_test(when_nothing_can_be_used_the_command_fails_and_leaves_no_file),
        cmocka_unit_test(a_session_without_photographs_is_refused),
        cmocka_unit_test(a_full_disk_leaves_nothing_behind),
        cmocka_unit_test(the_report_names_every_view_and_shows_it),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
