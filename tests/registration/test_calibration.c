/* Poses found with a calibration that is not quite that of the camera: vignetting, the second coefficient of the lens
 * and the scale of the print, which registration believes otherwise. Photographs are made with the true values. */
#include "registration/pose/pose_chain.h"

#include "plate.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 416, TEXELS = 64, TILTS = 2 };

static const double distance_mm = 600, opening_mm = 32;
static const weft_pose_limits limits = {4, 0.8};
static const double tilt_deg[TILTS] = {20, 60};

/* RMS distance on the opening, in texels, between a plate point and the one that registration takes a pixel for. */
static double error_texels(const weft_camera *truth, const weft_camera *believed, const weft_pose *pose,
                           const weft_homography *found)
{
    enum { GRID = 9 };
    const weft_homography seen_from = weft_homography_of_pose(truth, pose), back = weft_homography_inverse(found);
    double sum = 0;
    for (int i = 0; i < GRID * GRID; i++) {
        double x = opening_mm * (i % GRID / (GRID - 1.0) - 0.5), y = opening_mm * (i / GRID / (GRID - 1.0) - 0.5);
        weft_pixel pixel = weft_camera_distort(truth, weft_homography_apply(&seen_from, x, y));
        pixel = weft_camera_undistort(believed, pixel);
        weft_pixel place = weft_homography_apply(&back, pixel.x, pixel.y);
        sum += (place.x - x) * (place.x - x) + (place.y - y) * (place.y - y);
    }
    return sqrt(sum / (GRID * GRID)) * TEXELS / opening_mm;
}

/* Largest error over the tilts where the photograph is taken by `truth` of a plate printed `scale` times too large. */
static double worst_error(const weft_camera *truth, const weft_camera *believed, double scale)
{
    const weft_target target = weft_target_for_opening(opening_mm);
    plate_scene scene = {weft_target_for_opening(opening_mm * scale), 0.1, 0.005, 16, 0, NULL};
    weft_sight sight;
    double worst = 0;
    assert_int_equal(weft_sight_create(believed, &target, believed->fx / distance_mm, &sight, NULL), WEFT_OK);
    for (int i = 0; i < TILTS; i++) {
        weft_angles view = {weft_rad_of_deg(tilt_deg[i]), 0.3 + i};
        weft_pose nominal = weft_pose_of_view(view, distance_mm);
        weft_pose pose = plate_jittered_pose(view, distance_mm, (unsigned)i + 1);
        weft_homography promised = weft_homography_of_pose(believed, &nominal);
        weft_view_pose found;
        float *picture = plate_photograph(&scene, truth, &pose, 9);
        for (int k = 0; k < SIZE * SIZE; k++)
            picture[k] *= sight.inverse_vignetting[k];
        assert_int_equal(
            weft_pose_find(&sight, &target, picture, &promised, (weft_point_spread){0, 0}, &limits, &found, NULL),
            WEFT_OK);
        assert_int_equal(found.source, WEFT_POSE_DRAWING);
        /* What is registered is the opening as it is printed. */
        weft_homography as_printed = found.homography;
        for (int row = 0; row < 3; row++) {
            as_printed.m[row][0] /= scale;
            as_printed.m[row][1] /= scale;
        }
        double error = error_texels(truth, believed, &pose, &as_printed);
        print_message("tilt %g: %.4f texels\n", tilt_deg[i], error);
        worst = fmax(worst, error);
        free(picture);
    }
    weft_sight_free(&sight);
    return worst;
}

static void vignetting_may_be_unknown(void **state)
{
    (void)state;
    weft_camera truth = plate_camera(SIZE, distance_mm), believed = truth;
    truth.vignetting[0] = -20;
    believed.vignetting[0] = believed.vignetting[1] = 0;
    assert_true(worst_error(&truth, &believed, 1) < 0.05);
}

static void the_second_coefficient_of_the_lens_may_be_unknown(void **state)
{
    (void)state;
    weft_camera truth = plate_camera(SIZE, distance_mm), believed = truth;
    truth.k2 = 10;
    believed.k2 = 0;
    assert_true(worst_error(&truth, &believed, 1) < 0.05);
}

static void the_print_may_be_a_little_too_large(void **state)
{
    (void)state;
    weft_camera truth = plate_camera(SIZE, distance_mm);
    assert_true(worst_error(&truth, &truth, 1.003) < 0.05);
}

int test_calibration(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vignetting_may_be_unknown),
        cmocka_unit_test(the_second_coefficient_of_the_lens_may_be_unknown),
        cmocka_unit_test(the_print_may_be_a_little_too_large),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
