#include "registration/resample/resample.h"

#include "btf/dataset/dataset.h"
#include "plate.h"
#include "tests/registration/near.h"
#include "tests/support/cmocka_all.h"

#include <stdlib.h>

enum { SIZE = 200, TEXELS = 16, BLACK = 64, FULL = 65535 };

static const double opening_mm = 32;

static uint16_t samples[SIZE * SIZE * 3];
static float texel[TEXELS * TEXELS * 3];
static uint8_t mask[TEXELS * TEXELS];

static weft_camera flat_camera(void)
{
    return (weft_camera){.width = SIZE, .height = SIZE, .fx = 1000, .fy = 1000, .cx = 99.5, .cy = 99.5};
}

/* `scale` pixels a mm, origin at the pixel (x, y), y up on the plate. */
static weft_homography frontal(double scale, double x, double y)
{
    return (weft_homography){{{scale, 0, x}, {0, -scale, y}, {0, 0, 1}}};
}

static void resample_as(weft_resampling resampling)
{
    weft_resampler resampler;
    assert_int_equal(weft_resampler_create(&resampling, TEXELS, TEXELS, &resampler, NULL), WEFT_OK);
    weft_resampler_apply(&resampler, samples, BLACK, FULL, texel, mask);
    weft_resampler_free(&resampler);
}

static void resample(const weft_camera *camera, const float *inverse_vignetting, const weft_homography *homography)
{
    resample_as((weft_resampling){camera, inverse_vignetting, *homography, {0, 0, 0}, opening_mm, 0, false});
}

static void fill_with(double (*value)(double x, double y))
{
    for (int y = 0; y < SIZE; y++) {
        for (int x = 0; x < SIZE; x++) {
            for (int c = 0; c < 3; c++)
                samples[3 * (y * SIZE + x) + c] = (uint16_t)(BLACK + value(x, y));
        }
    }
}

static double constant(double x, double y)
{
    (void)x, (void)y;
    return 12345;
}

static double ramp(double x, double y)
{
    return 100 * x + 37 * y;
}

static double step(double x, double y)
{
    (void)y;
    return x < 100 ? 0 : 10000;
}

static void a_constant_stays_constant_under_tilt_and_distortion(void **state)
{
    (void)state;
    weft_camera camera = plate_camera(SIZE, 600);
    weft_pose pose = plate_jittered_pose((weft_angles){weft_rad_of_deg(70), 1}, 600, 3);
    weft_homography homography = weft_homography_of_pose(&camera, &pose);
    fill_with(constant);
    resample_as((weft_resampling){&camera, NULL, homography, {0, 0, 0}, opening_mm, 0, true});
    for (int i = 0; i < TEXELS * TEXELS; i++) {
        assert_near((double)texel[3 * i + 1] / 12345, 1, 1e-6);
        assert_int_equal(mask[i], 0);
    }
}

static void a_linear_ramp_is_reproduced_where_texels_hold_whole_pixels(void **state)
{
    (void)state;
    weft_camera camera = flat_camera();
    weft_homography homography = frontal(2.5, 99.5, 99.5); /* a texel is 5 x 5 pixels */
    fill_with(ramp);
    resample(&camera, NULL, &homography);
    for (int y = 1; y + 1 < TEXELS; y++) {
        for (int x = 1; x + 1 < TEXELS; x++) {
            double u = 99.5 + 5 * (x + 0.5 - TEXELS / 2), v = 99.5 + 5 * (y + 0.5 - TEXELS / 2);
            assert_near((double)texel[3 * (y * TEXELS + x)] / ramp(u, v), 1, 1e-6);
        }
    }
}

/* Moving the plate by any fraction of a pixel moves a texel's value by exactly that fraction. */
static void sub_pixel_shifts_are_exact(void **state)
{
    (void)state;
    weft_camera camera = flat_camera();
    fill_with(step);
    for (int i = 0; i <= 200; i++) {
        double shift = i / 200.0; /* the edge of the step, x = 99.5, is 2.5 + shift pixels into the middle texel */
        weft_homography homography = frontal(2.5, 97 - shift, 99.5);
        resample(&camera, NULL, &homography);
        double covered = (2.5 - shift) / 5;
        assert_near((double)texel[3 * (8 * TEXELS + 8)] / 10000, covered, 1e-6);
    }
}

static void row_zero_is_the_top_of_the_opening(void **state)
{
    (void)state;
    weft_camera camera = flat_camera();
    weft_homography homography = frontal(2.5, 99.5, 99.5);
    fill_with(ramp);
    resample(&camera, NULL, &homography);
    /* The photograph's row grows downwards, and so does the texel's. */
    assert_true(texel[3 * (2 * TEXELS + 5)] < texel[3 * (9 * TEXELS + 5)]);
}

static void vignetting_is_taken_out(void **state)
{
    (void)state;
    weft_camera camera = flat_camera();
    weft_homography homography = frontal(2.3, 99.5, 99.5);
    static float inverse[SIZE * SIZE];
    for (int i = 0; i < SIZE * SIZE; i++) {
        double response = 0.5 + 0.5 * (i % SIZE) / SIZE;
        inverse[i] = (float)(1 / response);
        for (int c = 0; c < 3; c++)
            samples[3 * i + c] = (uint16_t)lround(BLACK + 40000 * response);
    }
    resample(&camera, inverse, &homography);
    for (int i = 0; i < TEXELS * TEXELS; i++)
        assert_near((double)texel[3 * i] / 40000, 1, 3e-5);
}

static void a_saturated_pixel_masks_the_texels_it_touches_and_no_others(void **state)
{
    (void)state;
    weft_camera camera = flat_camera();
    weft_homography homography = frontal(2.5, 99.5, 99.5);
    fill_with(constant);
    samples[3 * (102 * SIZE + 102) + 2] = FULL;
    resample(&camera, NULL, &homography);
    for (int i = 0; i < TEXELS * TEXELS; i++)
        assert_int_equal(mask[i], i == 8 * TEXELS + 8 ? WEFT_MASK_SATURATED : 0);
}

static void texels_outside_the_photograph_are_missing(void **state)
{
    (void)state;
    weft_camera camera = flat_camera();
    weft_homography homography = frontal(2.5, 30, 99.5);
    fill_with(constant);
    resample(&camera, NULL, &homography);
    assert_int_equal(mask[5 * TEXELS], WEFT_MASK_MISSING);
    assert_int_equal(mask[5 * TEXELS + 15], 0);
}

static double bright_frame(double x, double y)
{
    /* The opening ends at 99.5 +- 40 pixels, in the middle of a pixel's square. */
    return fabs(x - 99.7) < 40 && fabs(y - 99.7) < 40 ? 100 : 60000;
}

static void the_bright_frame_does_not_leak_into_the_border(void **state)
{
    (void)state;
    weft_camera camera = flat_camera();
    weft_homography homography = frontal(2.5, 99.7, 99.7);
    fill_with(bright_frame);
    resample(&camera, NULL, &homography);
    for (int i = 0; i < TEXELS * TEXELS; i++) {
        assert_int_equal(mask[i], 0);
        assert_near((double)texel[3 * i], 100, 0.01);
    }
}

/* Texels of 0.8 pixels in an opening of 93.4 to 106.2. Whole pixels lie in it from 93.5 to 105.5, so that seven eighths
 * of the texels at the left and top are seen, one eighth at the right and bottom. */
static void texels_of_which_less_than_a_quarter_is_seen_are_missing(void **state)
{
    (void)state;
    weft_camera camera = flat_camera();
    weft_homography homography = frontal(0.4, 99.8, 99.8);
    fill_with(ramp);
    resample(&camera, NULL, &homography);
    for (int i = 0; i < TEXELS * TEXELS; i++) {
        bool is_seen = i % TEXELS < TEXELS - 1 && i / TEXELS < TEXELS - 1;
        assert_int_equal(mask[i], is_seen ? 0 : WEFT_MASK_MISSING);
    }
    assert_near((double)texel[3 * 5 * TEXELS] - (double)texel[3 * (5 * TEXELS + 1)], 100 * (94 - 94.625), 0.01);
}

static double small_bright_frame(double x, double y)
{
    return x > 93.4 && x < 106.2 && y > 93.4 && y < 106.2 ? 100 * x : 60000;
}

/* What is seen ends at 105.5 at the right: the last texel is taken from the pixels 104 and 105. */
static void texels_that_are_filled_take_the_nearest_place_that_is_seen(void **state)
{
    (void)state;
    weft_camera camera = flat_camera();
    fill_with(small_bright_frame);
    resample_as((weft_resampling){&camera, NULL, frontal(0.4, 99.8, 99.8), {0, 0, 0}, opening_mm, 0, true});
    for (int i = 0; i < TEXELS * TEXELS; i++) {
        assert_int_equal(mask[i], 0);
        assert_true(texel[3 * i] < 100 * 105.5f);
    }
    float last = texel[3 * (5 * TEXELS + TEXELS - 1)];
    assert_true(last > 100 * 104 && last <= 100 * 105.01f);
}

static void a_size_without_texels_is_refused(void **state)
{
    (void)state;
    weft_camera camera = flat_camera();
    weft_resampling resampling = {&camera, NULL, frontal(1, 0, 0), {0, 0, 0}, opening_mm, 0, false};
    weft_resampler resampler;
    assert_int_equal(weft_resampler_create(&resampling, 0, 4, &resampler, NULL), WEFT_BAD_INPUT);
}

int test_resample(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_constant_stays_constant_under_tilt_and_distortion),
        cmocka_unit_test(a_linear_ramp_is_reproduced_where_texels_hold_whole_pixels),
        cmocka_unit_test(sub_pixel_shifts_are_exact),
        cmocka_unit_test(row_zero_is_the_top_of_the_opening),
        cmocka_unit_test(vignetting_is_taken_out),
        cmocka_unit_test(a_saturated_pixel_masks_the_texels_it_touches_and_no_others),
        cmocka_unit_test(texels_outside_the_photograph_are_missing),
        cmocka_unit_test(the_bright_frame_does_not_leak_into_the_border),
        cmocka_unit_test(texels_of_which_less_than_a_quarter_is_seen_are_missing),
        cmocka_unit_test(texels_that_are_filled_take_the_nearest_place_that_is_seen),
        cmocka_unit_test(a_size_without_texels_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
