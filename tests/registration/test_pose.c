#include "registration/pose/markers.h"
#include "registration/pose/pose_chain.h"

#include "plate.h"
#include "tests/registration/near.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/suite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 416, TEXELS = 64 };

static const double distance_mm = 600, opening_mm = 32;
static const weft_pose_limits limits = {4, 0.8};

static weft_camera camera;
static weft_sight sight;
static plate_scene scene;

static int look(void **state)
{
    (void)state;
    camera = plate_camera(SIZE, distance_mm);
    scene = (plate_scene){weft_target_for_opening(opening_mm), 0.3, 0.01, 16, 0, NULL};
    return weft_sight_create(&camera, &scene.target, camera.fx / distance_mm, &sight, NULL) == WEFT_OK ? 0 : -1;
}

static int leave(void **state)
{
    (void)state;
    weft_sight_free(&sight);
    return 0;
}

/* Photographs the plate at a tilt; the true pose and the expected homography come back. */
static float *photograph(const plate_scene *what, double tilt_deg, weft_pose *pose, weft_homography *expected)
{
    weft_angles view = {weft_rad_of_deg(tilt_deg), 0.3 + tilt_deg};
    weft_pose nominal = weft_pose_of_view(view, distance_mm);
    *pose = plate_jittered_pose(view, distance_mm, (unsigned)tilt_deg + 1);
    *expected = weft_homography_of_pose(&camera, &nominal);
    float *picture = plate_photograph(what, &camera, pose, 9);
    for (int i = 0; i < SIZE * SIZE; i++)
        picture[i] *= sight.inverse_vignetting[i];
    return picture;
}

static double error_texels(const weft_pose *pose, const weft_homography *found)
{
    return plate_error_mm(&camera, pose, found, opening_mm) * TEXELS / opening_mm;
}

static weft_view_pose find(const plate_scene *what, double tilt_deg, double *error)
{
    weft_pose pose;
    weft_homography expected;
    float *picture = photograph(what, tilt_deg, &pose, &expected);
    weft_view_pose found;
    assert_int_equal(
        weft_pose_find(&sight, &what->target, picture, &expected, (weft_point_spread){0, 0}, &limits, &found, NULL),
        WEFT_OK);
    *error = error_texels(&pose, &found.homography);
    free(picture);
    return found;
}

/* Half the floors of the project: 0.05 texels in the median and 0.15 at worst, up to 75 degrees. */
static void poses_are_found_at_every_tilt_with_noise_defocus_and_a_light_gradient(void **state)
{
    (void)state;
    for (int tilt = 0; tilt <= 75; tilt += suite_argument ? 25 : 75) {
        double error;
        weft_view_pose found = find(&scene, tilt, &error);
        print_message("tilt %d: %.4f texels, estimated %.4f, correlation %.4f\n", tilt, error,
                      found.uncertainty_mm * TEXELS / opening_mm, found.correlation);
        assert_int_equal(found.source, WEFT_POSE_DRAWING);
        assert_int_equal(found.marker_count, WEFT_TARGET_MARKER_COUNT);
        assert_true(error < (tilt <= 60 ? 0.025 : 0.075));
    }
}

static void the_point_spread_of_the_lens_is_found_with_the_pose(void **state)
{
    (void)state;
    double error;
    weft_view_pose found = find(&scene, 60, &error);
    /* A disc of radius 16 |1 - focus / z| has a variance of a quarter of its square on each axis. */
    assert_near(found.point_spread.depth / (16 * 16 / 4.0), 1, 0.25);
}

static void markers_alone_come_within_half_a_texel(void **state)
{
    (void)state;
    for (int tilt = 0; tilt <= 75; tilt += 75) {
        weft_pose pose;
        weft_homography expected;
        weft_marker_start start;
        float *picture = photograph(&scene, tilt, &pose, &expected);
        assert_int_equal(weft_markers_locate(&sight, &scene.target, picture, &expected, &start, NULL), WEFT_OK);
        assert_int_equal(start.found, WEFT_TARGET_MARKER_COUNT);
        assert_true(start.corners >= 24);
        assert_true(error_texels(&pose, &start.homography) < 0.5);
        free(picture);
    }
}

static void the_rigs_promise_is_start_enough_without_markers(void **state)
{
    (void)state;
    weft_pose pose;
    weft_homography expected;
    float *picture = photograph(&scene, 45, &pose, &expected);
    weft_refinement refinement = {.homography = expected};
    const double blur[] = {4, 1.5, 0};
    for (int i = 0; i < 3; i++)
        assert_int_equal(weft_refinement_run(&sight, picture, blur[i], &refinement, NULL), WEFT_OK);
    assert_true(refinement.converged);
    assert_true(error_texels(&pose, &refinement.homography) < 0.025);
    free(picture);
}

static void a_plate_covered_in_part_is_found_all_the_same(void **state)
{
    (void)state;
    plate_scene covered = scene;
    covered.covered = 0.4;
    double error;
    weft_view_pose found = find(&covered, 30, &error);
    assert_int_equal(found.source, WEFT_POSE_DRAWING);
    assert_true(error < 0.1);
}

static void a_covered_plate_fails_and_says_why(void **state)
{
    (void)state;
    plate_scene covered = scene;
    covered.covered = 2;
    double error;
    weft_view_pose found = find(&covered, 30, &error);
    assert_int_equal(found.source, WEFT_POSE_FAILED);
    assert_non_null(strstr(found.remark, "not visible"));
}

static void darkness_fails(void **state)
{
    (void)state;
    weft_pose nominal = weft_pose_of_view((weft_angles){0, 0}, distance_mm);
    weft_homography expected = weft_homography_of_pose(&camera, &nominal);
    weft_view_pose found;
    float *black = calloc(SIZE * SIZE, sizeof *black);
    assert_int_equal(
        weft_pose_find(&sight, &scene.target, black, &expected, (weft_point_spread){0, 0}, &limits, &found, NULL),
        WEFT_OK);
    assert_int_equal(found.source, WEFT_POSE_FAILED);
    free(black);
}

static void a_plate_far_from_where_the_rig_expects_it_is_not_believed(void **state)
{
    (void)state;
    weft_pose pose;
    weft_homography expected;
    float *picture = photograph(&scene, 15, &pose, &expected);
    weft_pose_limits narrow = {0.001, 0.8};
    weft_view_pose found;
    assert_int_equal(
        weft_pose_find(&sight, &scene.target, picture, &expected, (weft_point_spread){0, 0}, &narrow, &found, NULL),
        WEFT_OK);
    assert_int_equal(found.source, WEFT_POSE_FAILED);
    assert_non_null(strstr(found.remark, "its place in the rig file"));
    free(picture);
}

int test_pose(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(poses_are_found_at_every_tilt_with_noise_defocus_and_a_light_gradient),
        cmocka_unit_test(the_point_spread_of_the_lens_is_found_with_the_pose),
        cmocka_unit_test(markers_alone_come_within_half_a_texel),
        cmocka_unit_test(the_rigs_promise_is_start_enough_without_markers),
        cmocka_unit_test(a_plate_covered_in_part_is_found_all_the_same),
        cmocka_unit_test(a_covered_plate_fails_and_says_why),
        cmocka_unit_test(darkness_fails),
        cmocka_unit_test(a_plate_far_from_where_the_rig_expects_it_is_not_believed),
    };
    return cmocka_run_group_tests(tests, look, leave);
}
