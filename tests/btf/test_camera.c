#include "btf/session/camera.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const weft_camera camera = {.width = 416,
                                   .height = 416,
                                   .fx = 3850,
                                   .fy = 3845,
                                   .cx = 206.3,
                                   .cy = 209.1,
                                   .k1 = -0.35,
                                   .k2 = 1.2,
                                   .vignetting = {-0.4, 0.1, 0}};
static const double distance_mm = 1000;

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.12g is not within %g of %.12g", value, tolerance, expected);
}

static weft_angles angles_deg(double theta_deg, double phi_deg)
{
    return (weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)};
}

static void pose_is_a_rotation_and_puts_the_camera_in_the_view_direction(void **state)
{
    (void)state;
    for (int index = 0; index < WEFT_UBO81_COUNT; index++) {
        weft_angles view = weft_ubo81_angles(index);
        weft_pose pose = weft_pose_of_view(view, distance_mm);
        for (int a = 0; a < 3; a++) {
            for (int b = 0; b < 3; b++) {
                double dot = 0;
                for (int k = 0; k < 3; k++)
                    dot += pose.rotation[a][k] * pose.rotation[b][k];
                assert_near(dot, a == b, 1e-14);
            }
        }
        weft_vec3 position = weft_pose_camera_position(&pose), direction = weft_direction_of_angles(view);
        assert_near(weft_length(weft_subtract(position, weft_scale(direction, distance_mm))), 0, 1e-9);
    }
}

static void frontal_view_from_phi_270_shows_u_right_and_v_up(void **state)
{
    (void)state;
    /* At the zenith up is -(cos phi, sin phi, 0): phi = 270 degrees puts +y up. */
    weft_pose pose = weft_pose_of_view(angles_deg(0, 270), distance_mm);
    weft_homography homography = weft_homography_of_pose(&camera, &pose);
    weft_pixel origin = weft_homography_apply(&homography, 0, 0);
    weft_pixel right = weft_homography_apply(&homography, 10, 0), up = weft_homography_apply(&homography, 0, 10);
    assert_near(origin.x, camera.cx, 1e-9);
    assert_near(origin.y, camera.cy, 1e-9);
    assert_near(right.x - origin.x, camera.fx * 10 / distance_mm, 1e-9);
    assert_near(up.y - origin.y, -camera.fy * 10 / distance_mm, 1e-9);
}

static void grazing_view_foreshortens_along_the_meridian(void **state)
{
    (void)state;
    weft_pose pose = weft_pose_of_view(angles_deg(75, 0), distance_mm);
    weft_homography homography = weft_homography_of_pose(&camera, &pose);
    weft_pixel origin = weft_homography_apply(&homography, 0, 0);
    weft_pixel toward = weft_homography_apply(&homography, 0.01, 0),
               across = weft_homography_apply(&homography, 0, 0.01);
    /* The side toward the camera lies lower in the picture, shortened by cos 75. */
    assert_near((toward.y - origin.y) / (camera.fy * 0.01 / distance_mm), cos(weft_rad_of_deg(75)), 1e-4);
    assert_near(fabs(across.x - origin.x) / (camera.fx * 0.01 / distance_mm), 1, 1e-4);
}

static void homography_inverse_undoes_it(void **state)
{
    (void)state;
    weft_pose pose = weft_pose_of_view(angles_deg(60, 100), distance_mm);
    weft_homography forward = weft_homography_of_pose(&camera, &pose), back = weft_homography_inverse(&forward);
    weft_pixel pixel = weft_homography_apply(&forward, 12.5, -7.25);
    weft_pixel plate = weft_homography_apply(&back, pixel.x, pixel.y);
    assert_near(plate.x, 12.5, 1e-9);
    assert_near(plate.y, -7.25, 1e-9);
    weft_homography singular = {{{1, 2, 3}, {2, 4, 6}, {0, 0, 1}}};
    assert_true(weft_homography_inverse(&singular).m[2][2] == 0);
}

/* The equations of the header, worked out by hand for one place. */
static void a_lens_distorts_by_all_its_coefficients(void **state)
{
    (void)state;
    weft_camera all = camera;
    weft_pixel straight = {camera.cx + camera.fx * 0.3, camera.cy - camera.fy * 0.2};
    weft_pixel bent = weft_camera_distort(&camera, straight);
    assert_near((bent.x - camera.cx) / camera.fx, 0.292434, 1e-12);
    assert_near((bent.y - camera.cy) / camera.fy, -0.194956, 1e-12);
    all.k3 = 0.5;
    all.p1 = 0.01;
    all.p2 = -0.02;
    bent = weft_camera_distort(&all, straight);
    assert_near((bent.x - all.cx) / all.fx, 0.28536355, 1e-12);
    assert_near((bent.y - all.cy) / all.fy, -0.1906757, 1e-12);
}

static void undistort_inverts_distort_over_the_whole_photograph(void **state)
{
    (void)state;
    for (int y = 0; y < camera.height; y += 13) {
        for (int x = 0; x < camera.width; x += 13) {
            weft_pixel pixel = {x, y};
            weft_pixel back = weft_camera_distort(&camera, weft_camera_undistort(&camera, pixel));
            assert_near(back.x, x, 1e-9);
            assert_near(back.y, y, 1e-9);
        }
    }
}

static void vignetting_is_one_on_the_axis_and_falls_outward(void **state)
{
    (void)state;
    assert_near(weft_camera_vignetting(&camera, (weft_pixel){camera.cx, camera.cy}), 1, 1e-12);
    double corner = weft_camera_vignetting(&camera, (weft_pixel){0, 0});
    assert_true(corner < 1 && corner > 0.99);
}

int test_camera(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pose_is_a_rotation_and_puts_the_camera_in_the_view_direction),
        cmocka_unit_test(frontal_view_from_phi_270_shows_u_right_and_v_up),
        cmocka_unit_test(grazing_view_foreshortens_along_the_meridian),
        cmocka_unit_test(homography_inverse_undoes_it),
        cmocka_unit_test(a_lens_distorts_by_all_its_coefficients),
        cmocka_unit_test(undistort_inverts_distort_over_the_whole_photograph),
        cmocka_unit_test(vignetting_is_one_on_the_axis_and_falls_outward),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
