/* The whole chain with two cameras of two models at once: frames of their faulty sensors, brackets, colours of their
 * own, the page of the night, registration; held against the truth. The virtual rig sees in linear sRGB. Each camera of
 * this test mixes the channels in its own way, after the sensor. */
#include "base/numeric/statistics.h"
#include "btf/dataset/dataset.h"
#include "btf/session/camera_list.h"
#include "capture/capture.h"
#include "capture/session_check.h"
#include "capture/virtual/ground_truth.h"
#include "registration/registration.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"
#include "tests/support/ground_truth.h"
#include "tests/support/scratch_folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { CAMERAS = 2, SHOTS = 6, SIZE = 208, TEXELS = 16, FRAMES = 4, BRACKETS = 2 };

static const char plan[] = "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n"
                           "45,130,0,0\n"
                           "10,0,30,90\n45,130,30,90\n"
                           "10,0,30,270\n45,130,30,270\n"
                           "10,0,45,200\n";

/* Of a raw value, from linear sRGB. No row sums to more than 1, so that what does not clip before does not after. */
static const double mixture[CAMERAS][3][3] = {{{0.60, 0.30, 0.05}, {0.15, 0.75, 0.10}, {0.02, 0.20, 0.60}},
                                              {{0.50, 0.10, 0.10}, {0.30, 0.50, 0.20}, {0.10, 0.02, 0.80}}};

typedef struct bench {
    weft_virtual_rig rig[CAMERAS];
    weft_rig_camera camera[CAMERAS]; /* what the mixing ones call */
    weft_colour colour[CAMERAS];
} bench;

static bench b;

/* ---- Cameras with colours of their own ---- */

static void mix(const double by[3][3], int black, int full, uint16_t *pixel)
{
    const double light[3] = {pixel[0] - black, pixel[1] - black, pixel[2] - black};
    bool clipped = pixel[0] == full || pixel[1] == full || pixel[2] == full;
    for (int c = 0; c < 3; c++) {
        double value = black + by[c][0] * light[0] + by[c][1] * light[1] + by[c][2] * light[2];
        pixel[c] = (uint16_t)(clipped ? full : weft_clamp(value + 0.5, 0, full - 1));
    }
}

static weft_code expose(int camera, uint64_t frame, double exposure_s, uint16_t *samples, double *read_back_s,
                        weft_error *error)
{
    const weft_rig_settings *settings = &b.rig[camera].rig.settings;
    int black = (int)settings->black_level, full = (1 << (int)settings->bits) - 1;
    WEFT_TRY(b.camera[camera].expose(b.camera[camera].device, frame, exposure_s, samples, read_back_s, error));
    for (int i = 0; i < SIZE * SIZE; i++)
        mix(mixture[camera], black, full, samples + 3 * (size_t)i);
    return WEFT_OK;
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

/* The matrix that leads back, white being 1 in all channels: Cramer's rule. */
static weft_colour colour_of(const double by[3][3])
{
    weft_colour colour = {.terms = WEFT_COLOUR_LINEAR_TERMS};
    double m[3][3], determinant = 0;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            m[i][k] = by[i][k] / (by[i][0] + by[i][1] + by[i][2]);
    }
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            colour.matrix[k][i] = m[(i + 1) % 3][(k + 1) % 3] * m[(i + 2) % 3][(k + 2) % 3] -
                                  m[(i + 1) % 3][(k + 2) % 3] * m[(i + 2) % 3][(k + 1) % 3];
    }
    for (int k = 0; k < 3; k++)
        determinant += m[0][k] * colour.matrix[k][0];
    for (int i = 0; i < 9; i++)
        colour.matrix[i / 3][i % 3] /= determinant;
    return colour;
}

static void open_bench(void)
{
    weft_virtual_request request = {WEFT_ASSETS "/weaves/cotton_denim.wv", 5, weft_virtual_settings_default()};
    weft_virtual_settings *settings = &request.settings;
    weft_error error = {0};
    int count;
    settings->cameras = CAMERAS;
    settings->sensor_faults = 1;
    settings->dark_frames = settings->flat_frames = FRAMES;
    settings->rig.width_px = settings->rig.height_px = SIZE;
    settings->rig.focal_length_px = 960;
    settings->tiles_x = settings->tiles_y = 1;
    expect_ok(weft_virtual_rigs_open(&request, b.rig, &count, &error), &error);
    for (int i = 0; i < CAMERAS; i++) {
        weft_rig *rig = &b.rig[i].rig;
        b.camera[i] = rig->camera;
        b.colour[i] = colour_of(mixture[i]);
        rig->camera.expose = i == 0 ? expose_first : expose_second;
        rig->camera_model = i == 0 ? "one make" : "another make";
        rig->colour = &b.colour[i];
    }
}

static void close_bench(void)
{
    for (int i = 0; i < CAMERAS; i++)
        weft_virtual_rig_close(&b.rig[i]);
}

/* ---- The night ---- */

static int photograph(void)
{
    const weft_capture_request request = {
        .folder = "night", .plan = "plan.csv", .brackets = BRACKETS, .status = "status"};
    weft_capture capture;
    weft_error error = {0};
    open_bench();
    expect_ok(weft_capture_begin(&request, &b.rig[0].rig, NULL, &capture, &error), &error);
    expect_ok(weft_capture_take(&capture, NULL, NULL, &error), &error);
    int taken = capture.summary.taken;
    for (int i = 0; taken > 0 && i < CAMERAS; i++) {
        const weft_truth_request wanted = {i == 0 ? "0.truth.h5" : "1.truth.h5", TEXELS, SHOTS};
        expect_ok(weft_truth_write(&wanted, &capture.held[i].session, &b.rig[i], NULL, &error), &error);
    }
    weft_capture_end(&capture);
    close_bench();
    return taken;
}

static int enter(void **state)
{
    if (scratch_folder_enter(state) != 0)
        return -1;
    scratch_store("plan.csv", plan, sizeof plan - 1);
    return photograph() == SHOTS ? 0 : -1;
}

/* ---- What it left ---- */

static void each_camera_has_frames_brackets_and_colours_of_its_own(void **state)
{
    (void)state;
    weft_session *sessions;
    weft_error error = {0};
    int count, brackets[CAMERAS] = {0};
    expect_ok(weft_camera_sessions_open("night", &sessions, &count, &error), &error);
    assert_int_equal(count, CAMERAS);
    for (int i = 0; i < count; i++) {
        const weft_session *s = &sessions[i];
        weft_session_problems faults;
        assert_int_equal(weft_session_frame_count(s), 3 * FRAMES);
        for (int k = 0; k < 3 * FRAMES; k++)
            assert_true(s->frame[k].taken);
        for (int k = 0; k < s->shot_count; k++)
            brackets[i] += s->record[k].bracket_count;
        assert_true(brackets[i] > 0);
        assert_int_equal(s->colour.terms, WEFT_COLOUR_LINEAR_TERMS);
        assert_float_equal(s->colour.matrix[0][1], b.colour[i].matrix[0][1], 1e-9);
        expect_ok(weft_session_check(s, NULL, &faults, &error), &error);
        assert_int_equal(faults.count, 0);
        weft_session_problems_free(&faults);
    }
    assert_true(sessions[0].frame[0].crc32 != sessions[1].frame[0].crc32);
    print_message("brackets: %d and %d photographs more\n", brackets[0], brackets[1]);
    weft_camera_sessions_free(sessions, count);
    assert_int_equal(access("status/index.html", F_OK) + access("status/camera2/index.html", F_OK), 0);
    assert_int_equal(photograph(), 0);
}

/* ---- Registered ---- */

/* The median relative error of the samples of a camera, whose images begin at `first_image`. */
static double error_of_camera(int camera, int first_image, int shots, weft_dataset *dataset)
{
    truth real;
    truth_errors errors;
    weft_error error = {0};
    expect_ok(truth_read(camera == 0 ? "0.truth.h5" : "1.truth.h5", &real, &error), &error);
    double(*light_mm)[3] = calloc(SHOTS, sizeof *light_mm), *all = calloc(SHOTS * TEXELS * TEXELS * 3, sizeof *all);
    assert_non_null(light_mm);
    assert_non_null(all);
    memcpy(light_mm[first_image], real.light_mm, (size_t)shots * sizeof *light_mm);
    free(real.light_mm);
    real.light_mm = light_mm;
    real.shot_count = SHOTS;
    for (int i = 0; i < real.image_count; i++)
        real.image_shot[i] += first_image;
    expect_ok(truth_compare_reflectance(&real, dataset, &errors, &error), &error);
    int count = 0;
    for (int i = 0; i < real.image_count; i++) {
        memcpy(all + count, errors.error + (size_t)i * (size_t)errors.capacity, (size_t)errors.count[i] * sizeof *all);
        count += errors.count[i];
    }
    double median = weft_quantile(all, count, 0.5);
    free(all);
    truth_errors_free(&errors);
    truth_free(&real);
    return median;
}

/* Registers with the colours of the sessions, or with each other's. */
static void register_night(bool swapped, double median[CAMERAS])
{
    weft_registration_settings settings[CAMERAS];
    weft_registration registration[CAMERAS];
    weft_session *sessions;
    weft_dataset *dataset;
    weft_error error = {0};
    int count, image = 0;
    expect_ok(weft_camera_sessions_open("night", &sessions, &count, &error), &error);
    for (int i = 0; i < count; i++) {
        settings[i] = weft_registration_defaults(&sessions[i]);
        settings[i].width = settings[i].height = TEXELS;
        sessions[i].colour = b.colour[swapped ? 1 - i : i];
    }
    expect_ok(weft_register_cameras(sessions, count, "night.btf.h5", settings, NULL, registration, &error), &error);
    expect_ok(weft_dataset_open("night.btf.h5", &dataset, &error), &error);
    assert_int_equal(weft_dataset_get_layout(dataset)->image_count, SHOTS);
    for (int i = 0; i < count; i++) {
        median[i] = error_of_camera(i, image, sessions[i].shot_count, dataset);
        assert_int_equal(registration[i].found.sensor.dark_frames, FRAMES);
        image += sessions[i].shot_count;
        weft_registration_free(&registration[i]);
    }
    weft_dataset_close(dataset);
    weft_camera_sessions_free(sessions, count);
}

static void both_meet_in_the_colours_of_the_truth(void **state)
{
    (void)state;
    double own[CAMERAS] = {0}, swapped[CAMERAS] = {0};
    register_night(false, own);
    register_night(true, swapped);
    for (int i = 0; i < CAMERAS; i++) {
        print_message("camera %d: samples err by %.2f %% in the median, by %.2f %% with the colours of the other\n",
                      i + 1, 100 * own[i], 100 * swapped[i]);
        assert_true(own[i] < 0.02);
        assert_true(swapped[i] > 2 * own[i]);
    }
}

int test_cameras_chain(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_camera_has_frames_brackets_and_colours_of_its_own),
        cmocka_unit_test(both_meet_in_the_colours_of_the_truth),
    };
    return cmocka_run_group_tests(tests, enter, scratch_folder_leave);
}
