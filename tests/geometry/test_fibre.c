/* The reflectance of a yarn's surface. */
#include "btf/direction/direction.h"
#include "geometry/yarn/fibre.h"
#include "tests/support/cmocka_all.h"

#include <math.h>

static const weft_vec3 along = {1, 0, 0}, up = {0, 0, 1};

static double luminance(weft_fibre fibre, weft_vec3 light, weft_vec3 view)
{
    weft_fibre_view seen = weft_fibre_seen_from(&fibre, along, up, view);
    return weft_fibre_brdf(&seen, light).g;
}

static weft_vec3 at_angles(double theta_deg, double phi_deg)
{
    return weft_direction_of_angles((weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)});
}

static void exchanging_light_and_view_changes_nothing(void **state)
{
    (void)state;
    weft_fibre fibre = {{0.2, 0.3, 0.4}, {0.6, 0.6, 0.6}, 0.2, 1.55};
    for (int i = 0; i < 200; i++) {
        weft_vec3 a = at_angles(i * 7 % 90, i * 31 % 360), b = at_angles(i * 13 % 90, i * 53 % 360);
        assert_true(fabs(luminance(fibre, a, b) - luminance(fibre, b, a)) < 1e-12);
    }
}

static void the_highlight_lies_across_the_fibre(void **state)
{
    (void)state;
    weft_fibre fibre = {{0, 0, 0}, {1, 1, 1}, 0.1, 1.55};
    weft_vec3 light = at_angles(30, 0);
    double mirror = luminance(fibre, light, at_angles(30, 180));
    assert_true(mirror > 50 * luminance(fibre, light, at_angles(0, 0)));
    /* Inclined like the mirror direction, but turned about the fibre: still in the cone of the highlight. */
    weft_vec3 turned = weft_unit(weft_vec3_of(-0.5, 0.6, sqrt(0.75 - 0.36)));
    assert_true(luminance(fibre, light, turned) > 0.4 * mirror);
}

/* Reflected part of the light from one direction, by the midpoint rule over the hemisphere. */
static double albedo(weft_fibre fibre, weft_vec3 view)
{
    enum { STEPS_THETA = 200, STEPS_PHI = 400 };
    double sum = 0;
    for (int i = 0; i < STEPS_THETA; i++) {
        double theta = (i + 0.5) / STEPS_THETA * WEFT_PI / 2;
        for (int k = 0; k < STEPS_PHI; k++) {
            weft_vec3 light = weft_direction_of_angles((weft_angles){theta, (k + 0.5) / STEPS_PHI * 2 * WEFT_PI});
            sum += luminance(fibre, light, view) * cos(theta) * sin(theta);
        }
    }
    return sum * (WEFT_PI / 2 / STEPS_THETA) * (2 * WEFT_PI / STEPS_PHI);
}

static void the_highlight_reflects_less_than_arrives(void **state)
{
    (void)state;
    static const double width[3] = {0.05, 0.25, 1}, index[2] = {1.3, 3};
    for (int w = 0; w < 3; w++)
        for (int n = 0; n < 2; n++)
            for (int theta = 0; theta < 90; theta += 22)
                for (int phi = 0; phi <= 90; phi += 30) {
                    weft_fibre fibre = {{0, 0, 0}, {1, 1, 1}, width[w], index[n]};
                    assert_true(albedo(fibre, at_angles(theta, phi)) < 0.943);
                }
}

static void the_diffuse_term_reflects_its_albedo(void **state)
{
    (void)state;
    weft_fibre fibre = {{0.7, 0.7, 0.7}, {0, 0, 0}, 0.2, 1.55};
    assert_true(fabs(albedo(fibre, at_angles(40, 20)) - 0.7) < 1e-4);
}

/* Reflectance of unpolarised light (Fresnel 1823). */
static double fresnel(double cosine, double index)
{
    double inside = sqrt(1 - (1 - cosine * cosine) / (index * index));
    double across = (cosine - index * inside) / (cosine + index * inside);
    double along_plane = (index * cosine - inside) / (index * cosine + inside);
    return (across * across + along_plane * along_plane) / 2;
}

/* In the mirror direction along the fibre: Fresnel's reflectance over 4 cos^2, times the peak of a normalised Gaussian.
 */
static void the_peak_of_the_highlight_is_what_its_definition_says(void **state)
{
    (void)state;
    const double width = 0.1, index = 1.55, specular = 0.8;
    weft_fibre fibre = {{0, 0, 0}, {specular, specular, specular}, width, index};
    for (int theta = 0; theta <= 75; theta += 15) {
        double cosine = cos(weft_rad_of_deg(theta));
        double expected = specular * fresnel(cosine, index) / (sqrt(WEFT_PI) * width) / (4 * cosine * cosine);
        double seen = luminance(fibre, at_angles(theta, 0), at_angles(theta, 180));
        assert_true(fabs(seen / expected - 1) < 1e-9);
    }
}

int test_fibre(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exchanging_light_and_view_changes_nothing),
        cmocka_unit_test(the_highlight_lies_across_the_fibre),
        cmocka_unit_test(the_highlight_reflects_less_than_arrives),
        cmocka_unit_test(the_peak_of_the_highlight_is_what_its_definition_says),
        cmocka_unit_test(the_diffuse_term_reflects_its_albedo),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
