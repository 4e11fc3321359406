/* One step of a path of light. */
#include "geometry/light/light_path.h"
#include "tests/support/cmocka_all.h"

#include <math.h>

/* Directions of density cosine over pi: their mean is 2/3 of the normal, their mean square 1/2 along it and 1/4 across.
 */
static void directions_follow_the_cosine(void **state)
{
    (void)state;
    enum { SIDE = 200, COUNT = SIDE * SIDE };
    const weft_vec3 normal = weft_unit(weft_vec3_of(0.3, -0.5, 0.8));
    const weft_vec3 tangent = weft_unit(weft_cross(normal, weft_vec3_of(0, 0, 1)));
    const weft_vec3 axis[3] = {tangent, weft_cross(normal, tangent), normal};
    double mean[3] = {0}, square[3] = {0};
    for (int i = 0; i < COUNT; i++) {
        const double point[2] = {(i % SIDE + 0.5) / SIDE, ((double)(i / SIDE) + 0.5) / SIDE};
        weft_vec3 d = weft_path_cosine_direction(normal, tangent, point);
        assert_true(fabs(weft_length(d) - 1) < 1e-12);
        for (int k = 0; k < 3; k++) {
            mean[k] += weft_dot(d, axis[k]) / COUNT;
            square[k] += weft_dot(d, axis[k]) * weft_dot(d, axis[k]) / COUNT;
        }
    }
    for (int k = 0; k < 3; k++) {
        assert_float_equal(mean[k], k == 2 ? 2 / 3.0 : 0, 1e-4);
        assert_float_equal(square[k], k == 2 ? 0.5 : 0.25, 1e-4);
    }
}

/* A diffuser of some albedo in each channel: that is what is left of the light. */
static void a_reflection_leaves_the_albedo(void **state)
{
    (void)state;
    const weft_rgb albedo = {0.9, 0.5, 0.1}, f = {0.9 / WEFT_PI, 0.5 / WEFT_PI, 0.1 / WEFT_PI};
    weft_rgb throughput = {1, 1, 1};
    for (int bounce = 1; bounce <= 3; bounce++) {
        assert_true(weft_path_reflect(f, &throughput));
        assert_float_equal(throughput.r, pow(albedo.r, bounce), 1e-12);
        assert_float_equal(throughput.g, pow(albedo.g, bounce), 1e-12);
        assert_float_equal(throughput.b, pow(albedo.b, bounce), 1e-12);
    }
    assert_false(weft_path_reflect((weft_rgb){0, 0, 0}, &throughput));
}

int test_path_step(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_follow_the_cosine),
        cmocka_unit_test(a_reflection_leaves_the_albedo),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
