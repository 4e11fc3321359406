#include "capture/synthetic/plan.h"
#include "capture/synthetic/scene.h"
#include "tests/support/cmocka_all.h"

#include <stdlib.h>

static weft_synthetic_lens a_lens(void)
{
    weft_synthetic_request request = weft_synthetic_request_default();
    weft_synthetic_shot shot;
    request.photograph_count = 1;
    weft_synthetic_plan(&request, &shot);
    return shot.lens;
}

static const double middle_of_pupil[2] = {0, 0};

/* A point on the ray of a pixel is pictured at that pixel. */
static void a_ray_comes_back_to_its_pixel(void **state)
{
    (void)state;
    weft_synthetic_lens lens = a_lens();
    for (int i = 0; i < 100; i++) {
        double x = (lens.width - 1) * (i % 10) / 9.0, y = (lens.height - 1) * (i / 10) / 9.0, pixel[2];
        weft_synthetic_ray ray;
        weft_synthetic_lens_ray(&lens, x, y, middle_of_pupil, &ray);
        assert_true(weft_synthetic_lens_project(&lens, weft_scale(ray.along, 100 + 7 * i), pixel));
        assert_float_equal(pixel[0], x, 1e-6);
        assert_float_equal(pixel[1], y, 1e-6);
    }
}

/* Barrel: a corner is pictured nearer to the axis than a pinhole would, by some pixels; the middle of the field is not.
 */
static void the_lens_distorts(void **state)
{
    (void)state;
    weft_synthetic_lens lens = a_lens();
    double slope[2], scale = lens.image_distance_mm * lens.width / lens.sensor_width_mm;
    weft_synthetic_lens_slopes(&lens, lens.width - 1, lens.axis_y, slope);
    double moved = slope[0] * scale - (lens.width - 1 - lens.axis_x);
    assert_true(moved > 5 && moved < 80);
    weft_synthetic_lens_slopes(&lens, lens.axis_x + 30, lens.axis_y, slope);
    assert_float_equal(slope[0] * scale, 30, 0.01);
}

/* As docs/reference/synthetic.md has it: what a reader of the truth computes. */
static void the_distortion_is_that_of_the_truth(void **state)
{
    (void)state;
    weft_synthetic_lens lens = a_lens();
    double pitch = 23.5 / 3000, x = 2711, y = 1804, slope[2];
    double dx = (x - lens.axis_x) * pitch, dy = (y - lens.axis_y) * pitch;
    double q2 = (dx * dx + dy * dy) / (0.25 * pitch * pitch * (3000.0 * 3000 + 2000.0 * 2000));
    double scale = 1 + lens.division[0] * q2 + lens.division[1] * q2 * q2;
    weft_synthetic_lens_slopes(&lens, x, y, slope);
    assert_float_equal(slope[0] * scale * lens.image_distance_mm, dx, 1e-9);
    assert_float_equal(slope[1] * scale * lens.image_distance_mm, dy, 1e-9);
}

/* All rays of a pixel meet in the plane in focus, and nowhere nearer. */
static void rays_meet_in_focus(void **state)
{
    (void)state;
    weft_synthetic_lens lens = a_lens();
    double x = 0.3 * lens.width, y = 0.4 * lens.height, blur = 0;
    weft_synthetic_ray chief;
    weft_synthetic_lens_ray(&lens, x, y, middle_of_pupil, &chief);
    weft_vec3 sharp = weft_scale(chief.along, lens.focus_mm / chief.along.z);
    for (int i = 0; i < 16; i++) {
        double pupil[2] = {cos(i), sin(i)};
        weft_synthetic_ray ray;
        assert_true(weft_synthetic_lens_ray(&lens, x, y, pupil, &ray));
        weft_vec3 at = weft_add(ray.from, weft_scale(ray.along, (lens.focus_mm - ray.from.z) / ray.along.z));
        assert_true(weft_length(weft_subtract(at, sharp)) < 1e-9);
        weft_vec3 half = weft_add(ray.from, weft_scale(ray.along, 0.5 * lens.focus_mm / ray.along.z));
        blur = fmax(blur, weft_length(weft_subtract(half, weft_scale(sharp, 0.5))));
    }
    assert_float_equal(blur, 0.5 * lens.pupil_radius_mm, 0.01 * lens.pupil_radius_mm);
}

/* The area that two discs share. */
static double shared_area(double r, double big, double apart)
{
    if (apart <= big - r)
        return WEFT_PI * r * r;
    if (apart >= big + r)
        return 0;
    double a = acos((apart * apart + r * r - big * big) / (2 * apart * r));
    double b = acos((apart * apart + big * big - r * r) / (2 * apart * big));
    return r * r * (a - sin(2 * a) / 2) + big * big * (b - sin(2 * b) / 2);
}

/* The rim cuts the bundle of a pixel, a disc there, as a disc cuts a disc. */
static void the_rim_shades_the_corners(void **state)
{
    (void)state;
    weft_synthetic_lens lens = a_lens();
    double r = lens.pupil_radius_mm * (1 - lens.rim_mm / lens.focus_mm), least = 1;
    for (int i = 0; i <= 40; i++) {
        double x = lens.axis_x * (1 - i / 40.0), y = lens.axis_y * (1 - i / 40.0), slope[2];
        weft_synthetic_lens_slopes(&lens, x, y, slope);
        double cosine = 1 / sqrt(1 + slope[0] * slope[0] + slope[1] * slope[1]);
        double open = shared_area(r, lens.rim_radius_mm, lens.rim_mm * hypot(slope[0], slope[1])) / (WEFT_PI * r * r);
        assert_float_equal(weft_synthetic_lens_vignetting(&lens, x, y), open * pow(cosine, 4), 0.01);
        least = fmin(least, open);
    }
    assert_true(least > 0.3 && least < 0.9);
}

int test_synthetic_lens(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ray_comes_back_to_its_pixel),       cmocka_unit_test(the_lens_distorts),
        cmocka_unit_test(the_distortion_is_that_of_the_truth), cmocka_unit_test(rays_meet_in_focus),
        cmocka_unit_test(the_rim_shades_the_corners),
    };
    return cmocka_run_group_tests_name("synthetic lens", tests, NULL, NULL);
}
