#include "registration/radiometry/radiometry.h"

#include "plate.h"
#include "tests/registration/near.h"
#include "tests/support/cmocka_all.h"

#include <stdlib.h>

enum { SIZE = 208, BLACK = 64, FULL = 4095 };

static const double distance_mm = 600, light_mm = 650;

static weft_target target;
static weft_sight sight;
static const weft_bend flat = {0, 0, 0};
static weft_homography homography;
static weft_reference_pixels reference;
static uint16_t *samples;
static weft_exposure exposure;

static int look(void **state)
{
    (void)state;
    target = weft_target_for_opening(32);
    weft_camera camera = plate_camera(SIZE, distance_mm);
    weft_pose pose = plate_jittered_pose((weft_angles){weft_rad_of_deg(30), 1}, distance_mm, 5);
    homography = weft_homography_of_pose(&camera, &pose);
    samples = malloc(SIZE * SIZE * 3 * sizeof *samples);
    return samples && weft_sight_create(&camera, &target, 2, &sight, NULL) == WEFT_OK &&
                   weft_reference_pixels_find(&sight, &target, &homography, (weft_point_spread){0, 0}, &reference,
                                              NULL) == WEFT_OK
               ? 0
               : -1;
}

static int leave(void **state)
{
    (void)state;
    free(samples);
    weft_reference_pixels_free(&reference);
    weft_sight_free(&sight);
    return 0;
}

/* The whole plate as one white diffuser of the patches' reflectance, under a light of the given direction. */
static void photograph_white(weft_angles light, double exposure_s, double brightness)
{
    weft_homography inverse = weft_homography_inverse(&homography);
    exposure = (weft_exposure){BLACK, FULL, exposure_s, weft_scale(weft_direction_of_angles(light), light_mm)};
    for (int i = 0; i < SIZE * SIZE; i++) {
        weft_pixel at =
            weft_homography_apply(&inverse, (double)sight.undistorted[i][0], (double)sight.undistorted[i][1]);
        /* Irradiance from first principles: cosine at the point, falloff against the origin. */
        weft_vec3 to_light = weft_subtract(exposure.light, (weft_vec3){at.x, at.y, 0});
        double r = weft_length(to_light), irradiance = to_light.z / r * (light_mm * light_mm) / (r * r);
        double value =
            brightness * exposure_s * target.white_reflectance * irradiance / (double)sight.inverse_vignetting[i];
        for (int c = 0; c < 3; c++)
            samples[3 * i + c] = (uint16_t)weft_clamp(BLACK + (c + 1) / 3.0 * value + 0.5, 0, FULL);
    }
}

static weft_white measure(void)
{
    return weft_white_measure(&sight, &target, &reference, samples, &exposure);
}

/* The lens of the plate loses next to nothing; this one loses a third where the patches are. What it loses is computed
 * from the definition in btf/session/camera.h, and a lens that wrongly claims to lose nothing is seen to. */
static void what_the_lens_loses_is_given_back(void **state)
{
    (void)state;
    const double loss = -60;
    weft_camera camera = plate_camera(SIZE, distance_mm);
    camera.vignetting[0] = loss;
    camera.vignetting[1] = camera.vignetting[2] = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        double x = ((double)sight.undistorted[i][0] - camera.cx) / camera.fx;
        double y = ((double)sight.undistorted[i][1] - camera.cy) / camera.fy;
        sight.inverse_vignetting[i] = (float)(1 / (1 + loss * (x * x + y * y)));
    }
    photograph_white((weft_angles){weft_rad_of_deg(40), 2}, 0.4, 8000);
    weft_white white = measure();
    assert_int_equal(white.patches, 4);
    assert_true(white.disagreement < 0.004);
    assert_near(white.level[1] / (8000 * 2 / 3.0), 1, 0.004);
    weft_sight own;
    assert_int_equal(weft_sight_create(&camera, &target, 2, &own, NULL), WEFT_OK);
    for (int i = 0; i < SIZE * SIZE; i += 101)
        assert_near((double)(own.inverse_vignetting[i] / sight.inverse_vignetting[i]), 1, 1e-4);
    weft_sight_free(&own);
}

static void irradiance_at_the_origin_is_the_cosine(void **state)
{
    (void)state;
    for (int tilt = 0; tilt < 90; tilt += 15) {
        weft_angles light = {weft_rad_of_deg(tilt), 2};
        double seen = weft_relative_irradiance(weft_scale(weft_direction_of_angles(light), 500), &flat, 0, 0);
        assert_near(seen, cos(light.theta_rad), 1e-12);
    }
}

static void all_four_patches_are_found_and_agree(void **state)
{
    (void)state;
    photograph_white((weft_angles){weft_rad_of_deg(60), 0.4}, 0.5, 8000);
    weft_white white = measure();
    assert_int_equal(white.patches, 4);
    assert_true(white.disagreement < 0.003);
}

static void the_white_level_does_not_depend_on_where_the_light_is(void **state)
{
    (void)state;
    for (int tilt = 0; tilt <= 75; tilt += 15) {
        photograph_white((weft_angles){weft_rad_of_deg(tilt), 0.4 * tilt}, 0.4, 8000);
        weft_white white = measure();
        assert_near(white.level[0] / (8000 / 3.0), 1, 0.004);
        assert_near(white.level[2] / 8000, 1, 0.004);
    }
}

static void a_white_diffuser_gives_its_reflectance_times_the_cosine_everywhere(void **state)
{
    (void)state;
    enum { TEXELS = 4 };
    for (int tilt = 0; tilt <= 75; tilt += 25) {
        weft_angles light = {weft_rad_of_deg(tilt), 1};
        exposure = (weft_exposure){BLACK, FULL, 0.25, weft_scale(weft_direction_of_angles(light), light_mm)};
        float texel[TEXELS * TEXELS * 3];
        weft_white white = {{3000, 2000, 1000}, 4, 0};
        for (int i = 0; i < TEXELS * TEXELS; i++) {
            double x = ((i % TEXELS + 0.5) / TEXELS - 0.5) * 32, y = (0.5 - (i / TEXELS + 0.5) / TEXELS) * 32;
            weft_vec3 to_light = weft_subtract(exposure.light, (weft_vec3){x, y, 0});
            double r = weft_length(to_light), irradiance = to_light.z / r * (light_mm * light_mm) / (r * r);
            for (int c = 0; c < 3; c++)
                texel[3 * i + c] = (float)(0.7 * white.level[c] * irradiance * exposure.exposure_s);
        }
        weft_reflectance_of_raw(&white, &exposure, &flat, 32, TEXELS, TEXELS, texel);
        for (int i = 0; i < TEXELS * TEXELS * 3; i++)
            assert_near((double)texel[i], 0.7 * cos(light.theta_rad), 1e-6);
    }
}

static void multiply_patch(int patch, double factor)
{
    for (int i = 0; i < reference.count[patch]; i++) {
        for (int c = 0; c < 3; c++) {
            uint16_t *s = &samples[3 * reference.pixel[patch][i] + c];
            *s = (uint16_t)weft_clamp(BLACK + factor * (*s - BLACK), 0, FULL);
        }
    }
}

static void a_stained_patch_is_left_out(void **state)
{
    (void)state;
    photograph_white((weft_angles){0.3, 0}, 0.4, 8000);
    multiply_patch(2, 0.5);
    weft_white white = measure();
    assert_int_equal(white.patches, 3);
    assert_near(white.level[2] / 8000, 1, 0.004);
}

static void saturated_patches_are_left_out(void **state)
{
    (void)state;
    photograph_white((weft_angles){0.3, 0}, 0.4, 8000);
    multiply_patch(0, 100);
    multiply_patch(1, 100);
    weft_white white = measure();
    assert_int_equal(white.patches, 2);
    assert_near(white.level[2] / 8000, 1, 0.004);
}

static void without_a_usable_patch_nothing_is_measured(void **state)
{
    (void)state;
    photograph_white((weft_angles){0.3, 0}, 0.4, 1e6);
    assert_int_equal(measure().patches, 0);
}

int test_radiometry(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(irradiance_at_the_origin_is_the_cosine),
        cmocka_unit_test(all_four_patches_are_found_and_agree),
        cmocka_unit_test(the_white_level_does_not_depend_on_where_the_light_is),
        cmocka_unit_test(a_white_diffuser_gives_its_reflectance_times_the_cosine_everywhere),
        cmocka_unit_test(a_stained_patch_is_left_out),
        cmocka_unit_test(saturated_patches_are_left_out),
        cmocka_unit_test(without_a_usable_patch_nothing_is_measured),
        cmocka_unit_test(what_the_lens_loses_is_given_back),
    };
    return cmocka_run_group_tests(tests, look, leave);
}
