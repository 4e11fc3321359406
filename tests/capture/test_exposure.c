#include "capture/exposure.h"
#include "tests/support/cmocka_all.h"

#include <stdlib.h>

enum { SIZE = 200 };

static const weft_exposure_limits limits = {1.0 / 4000, 2};

static weft_session make_session(void)
{
    return (weft_session){
        .camera = {.width = SIZE, .height = SIZE, .fx = 900, .fy = 900, .cx = (SIZE - 1) / 2.0, .cy = (SIZE - 1) / 2.0},
        .camera_distance_mm = 500,
        .bits = 12,
        .black_level = 64,
        .target = weft_target_for_opening(32)};
}

/* Sets the raw value of every listed pixel. */
static void paint(uint16_t *samples, const int *pixels, int count, uint16_t value)
{
    for (int i = 0; i < count; i++)
        samples[3 * (size_t)pixels[i] + 1] = value;
}

static void the_meter_reads_opening_and_white_patches_against_their_aims(void **state)
{
    (void)state;
    weft_session session = make_session();
    weft_meter meter;
    weft_angles view = {weft_rad_of_deg(45), weft_rad_of_deg(70)};
    assert_int_equal(weft_meter_make(&session, view, &meter, NULL), WEFT_OK);
    assert_true(meter.opening_count > 500 && meter.white_count > 300);
    uint16_t *samples = calloc((size_t)SIZE * SIZE * 3, sizeof *samples);
    assert_non_null(samples);
    const double full_scale = 4095 - 64;
    paint(samples, meter.opening, meter.opening_count, (uint16_t)(64 + 0.4 * full_scale));
    assert_true(fabs(weft_meter_read(&meter, &session, samples) - 0.4 / weft_opening_aim) < 1e-3);
    paint(samples, meter.white, meter.white_count, (uint16_t)(64 + 0.6 * full_scale));
    assert_true(fabs(weft_meter_read(&meter, &session, samples) - 0.6 / weft_white_aim) < 1e-3);
    free(samples);
    weft_meter_free(&meter);
}

static void the_meter_forgives_half_a_percent_of_glints(void **state)
{
    (void)state;
    weft_session session = make_session();
    weft_meter meter;
    assert_int_equal(weft_meter_make(&session, (weft_angles){0, 0}, &meter, NULL), WEFT_OK);
    uint16_t *samples = calloc((size_t)SIZE * SIZE * 3, sizeof *samples);
    assert_non_null(samples);
    paint(samples, meter.opening, meter.opening_count, 1000);
    paint(samples, meter.opening, meter.opening_count / 250, 4095);
    assert_true(weft_meter_read(&meter, &session, samples) < 0.3);
    paint(samples, meter.opening, meter.opening_count / 150, 4095);
    assert_true(weft_meter_read(&meter, &session, samples) > 1.2);
    free(samples);
    weft_meter_free(&meter);
}

static void a_view_past_the_sample_is_an_error(void **state)
{
    (void)state;
    weft_session session = make_session();
    session.camera.cx = 1e5;
    weft_meter meter;
    weft_error error = {0};
    assert_int_equal(weft_meter_make(&session, (weft_angles){0, 0}, &meter, &error), WEFT_BAD_INPUT);
    weft_meter_free(&meter);
}

static void exposures_are_third_stops_within_the_limits(void **state)
{
    (void)state;
    assert_true(fabs(weft_exposure_in_thirds(0.25, limits) - 0.25) < 1e-9);
    assert_true(fabs(weft_exposure_in_thirds(0.3, limits) - 0.25) < 1e-9);
    assert_true(fabs(weft_exposure_in_thirds(0.32, limits) - 0.25 * exp2(1 / 3.0)) < 1e-9);
    assert_true(weft_exposure_in_thirds(100, limits) <= 2);
    assert_true(weft_exposure_in_thirds(1e-9, limits) == limits.shortest_s);
}

static void an_exposure_settles_from_any_start(void **state)
{
    (void)state;
    const double right_s[] = {1.0 / 3000, 0.001, 0.0123, 0.4, 1.9};
    for (int i = 0; i < 5; i++) {
        for (double start_s = 0.0003; start_s < 2; start_s *= 3) {
            double exposure_s = weft_exposure_in_thirds(start_s, limits);
            int steps = 0;
            for (; steps < 8; steps++) {
                double level = fmin(exposure_s / right_s[i], 1.11); /* clipped at full scale */
                double next_s = weft_exposure_after(exposure_s, level, limits);
                if (next_s == exposure_s)
                    break;
                exposure_s = next_s;
            }
            assert_true(steps < 8);
            assert_true(exposure_s <= right_s[i] * 1.031 && exposure_s > right_s[i] * 0.75);
        }
    }
}

int test_exposure(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_meter_reads_opening_and_white_patches_against_their_aims),
        cmocka_unit_test(the_meter_forgives_half_a_percent_of_glints),
        cmocka_unit_test(a_view_past_the_sample_is_an_error),
        cmocka_unit_test(exposures_are_third_stops_within_the_limits),
        cmocka_unit_test(an_exposure_settles_from_any_start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
