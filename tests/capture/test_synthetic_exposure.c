/* How synthetic photographs are exposed: tone curves, and views that are photographed twice. */
#include "capture/synthetic/plan.h"

#include "tests/support/cmocka_all.h"

#include <string.h>

/* A toe, a shoulder, and no power law: the slope over that of sRGB goes up and down again. */
static void the_tone_curve_is_an_s(void **state)
{
    (void)state;
    double last = 0;
    assert_float_equal(weft_synthetic_tone(WEFT_SYNTHETIC_CONTRAST, 0), 0, 1e-12);
    assert_float_equal(weft_synthetic_tone(WEFT_SYNTHETIC_CONTRAST, 1), 1, 1e-12);
    for (int i = 1; i <= 1000; i++) {
        assert_true(weft_synthetic_tone(WEFT_SYNTHETIC_CONTRAST, i / 1000.0) > last);
        last = weft_synthetic_tone(WEFT_SYNTHETIC_CONTRAST, i / 1000.0);
    }
    assert_true(weft_synthetic_tone(WEFT_SYNTHETIC_CONTRAST, 0.004) < 0.6 * (12.92 * 0.004));
    assert_true(1 - weft_synthetic_tone(WEFT_SYNTHETIC_CONTRAST, 0.8) < 0.75 * (1 - 0.906));
}

/* Brighter than sRGB in the dark, by more than any error of a shutter, and as steep as film at its end. */
static void the_soft_curve_lifts_the_dark(void **state)
{
    (void)state;
    double last = 0;
    assert_float_equal(weft_synthetic_tone(WEFT_SYNTHETIC_SOFT, 0), 0, 1e-12);
    assert_float_equal(weft_synthetic_tone(WEFT_SYNTHETIC_SOFT, 1), 1, 1e-12);
    for (int i = 1; i <= 1000; i++) {
        assert_true(weft_synthetic_tone(WEFT_SYNTHETIC_SOFT, i / 1000.0) > last);
        last = weft_synthetic_tone(WEFT_SYNTHETIC_SOFT, i / 1000.0);
    }
    assert_true(weft_synthetic_tone(WEFT_SYNTHETIC_SOFT, 0.004) > 1.5 * (12.92 * 0.004));
    assert_true(1 - weft_synthetic_tone(WEFT_SYNTHETIC_SOFT, 0.8) < 0.5 * (1 - 0.906));
}

/* A view that is taken twice differs in its exposure, and in what hands move. */
static void a_series_is_one_view_two_stops_apart(void **state)
{
    (void)state;
    enum { SHOTS = 8 };
    weft_synthetic_request request = weft_synthetic_request_default();
    weft_synthetic_shot once[SHOTS], twice[SHOTS];
    request.photograph_count = SHOTS;
    weft_synthetic_plan(&request, once);
    request.series_count = 2;
    weft_synthetic_plan(&request, twice);
    int darker = 0;
    for (int i = 0; i < SHOTS; i++) {
        bool same = memcmp(&once[i].pose, &twice[i].pose, sizeof once[i].pose) == 0;
        if (same)
            continue;
        darker++;
        const weft_synthetic_shot *a = &twice[i - 1], *b = &twice[i];
        assert_float_equal(a->exposure.seconds / b->exposure.seconds, 4, 0.17); /* as engraved: 1/60 and 1/250 */
        assert_float_equal(a->exposure.gain / b->exposure.gain, 4, 0.08);
        assert_true(a->exposure.iso == b->exposure.iso);
        double camera =
            weft_length(weft_subtract(weft_pose_camera_position(&a->pose), weft_pose_camera_position(&b->pose)));
        double lamp = weft_length(weft_subtract(a->lamp.at, b->lamp.at));
        assert_true(camera > 0.01 && camera < 3 && lamp > 0.1 && lamp < 10);
        assert_string_not_equal(a->name, b->name);
        assert_true(a->key != b->key);
    }
    assert_int_equal(darker, 2);
}

int test_synthetic_exposure(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_tone_curve_is_an_s),
        cmocka_unit_test(the_soft_curve_lifts_the_dark),
        cmocka_unit_test(a_series_is_one_view_two_stops_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
