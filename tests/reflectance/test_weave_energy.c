/* No published fabric reflects more light than it receives: a twill of cotton and a satin of silk, or with an argument
 * all. Built twice: in double, and in single precision. */
#include "btf/direction/direction.h"
#include "reflectance/weave/weave.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/suite.h"

#include <stdio.h>

enum { RINGS = 32, AZIMUTHS = 64 };

static weft_weave read_fabric(const char *name)
{
    char path[512];
    weft_weave weave;
    weft_error error;
    snprintf(path, sizeof path, "%s/weaves/%s.wv", WEFT_ASSETS, name);
    if (weft_weave_read(path, NULL, 0, &weave, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    return weave;
}

static weft_vec3 direction(double theta_deg, double phi_deg)
{
    return weft_direction_of_angles(
        (weft_angles){weft_rad_of_deg((weft_real)theta_deg), weft_rad_of_deg((weft_real)phi_deg)});
}

/* Integral of BRDF times cosine over all views, the brightest channel: midpoints of equal parts of the projected
 * hemisphere. */
static double albedo(const weft_weave *weave, weft_vec3 light)
{
    double sum[3] = {0};
    for (int i = 0; i < RINGS * AZIMUTHS; i++) {
        double radius = sqrt((i / AZIMUTHS + 0.5) / RINGS), phi = 2 * (double)WEFT_PI * (i % AZIMUTHS + 0.5) / AZIMUTHS;
        weft_vec3 view = weft_vec3_of((weft_real)(radius * cos(phi)), (weft_real)(radius * sin(phi)),
                                      (weft_real)sqrt(1 - radius * radius));
        weft_rgb value = weft_weave_mean_brdf(weave, light, view);
        sum[0] += (double)value.r, sum[1] += (double)value.g, sum[2] += (double)value.b;
    }
    return fmax(fmax(sum[0], sum[1]), sum[2]) * (double)WEFT_PI / (RINGS * AZIMUTHS);
}

/* Largest and smallest albedo over lights from the normal to the horizon. */
static double largest_albedo(const weft_weave *weave, double *smallest)
{
    static const double theta[] = {0, 30, 60, 80, 89.5}, phi[] = {0, 55, 90};
    double largest = 0;
    *smallest = INFINITY;
    for (int i = 0; i < 5; i++) {
        for (int k = 0; k < 3; k++) {
            double value = albedo(weave, direction(theta[i], phi[k]));
            largest = fmax(largest, value);
            *smallest = fmin(*smallest, value);
        }
    }
    return largest;
}

static void published_fabrics_reflect_no_more_than_they_receive(void **state)
{
    (void)state;
    static const char *const name[] = {"cotton_denim",   "cotton_twill",  "polyester_lining",
                                       "silk_charmeuse", "silk_shantung", "wool_gabardine"};
    for (int i = 0; i < 6; i += suite_argument ? 1 : 3) {
        weft_weave weave = read_fabric(name[i]);
        double smallest, largest = largest_albedo(&weave, &smallest);
        print_message("%s: albedo %.3f to %.3f\n", name[i], smallest, largest);
        assert_true(smallest > 0.01);
        assert_true(largest <= 1);
        weft_weave_free(&weave);
    }
}

static void an_albedo_is_linear_in_the_colours(void **state)
{
    (void)state;
    weft_weave weave = read_fabric("silk_shantung");
    weft_vec3 light = direction(30, 55);
    double before = albedo(&weave, light);
    for (int i = 0; i < weave.yarn_count; i++) {
        weft_yarn *yarn = &weave.yarn[i];
        yarn->kd = (weft_rgb){3 * yarn->kd.r, 3 * yarn->kd.g, 3 * yarn->kd.b};
        yarn->ks = (weft_rgb){3 * yarn->ks.r, 3 * yarn->ks.g, 3 * yarn->ks.b};
    }
    assert_true(fabs(albedo(&weave, light) / before - 3) < 1e-4);
    weft_weave_free(&weave);
}

/* Without diffuse part and with ks = 1, the mean of the albedo over a cosine-weighted light is 1: what the constant s
 * is for. */
static void specular_light_is_normalised_over_both_hemispheres(void **state)
{
    (void)state;
    enum { LIGHTS = 64 };
    weft_weave weave = read_fabric("polyester_lining");
    double sum = 0;
    for (int i = 0; i < weave.yarn_count; i++) {
        weave.yarn[i].kd = (weft_rgb){0};
        weave.yarn[i].ks = (weft_rgb){1, 1, 1};
    }
    for (int i = 0; i < LIGHTS; i++) {
        double radius = sqrt((i + 0.5) / LIGHTS), turn = 2 * (double)WEFT_PI * i * 0.6180339887498949;
        sum += albedo(&weave, weft_vec3_of((weft_real)(radius * cos(turn)), (weft_real)(radius * sin(turn)),
                                           (weft_real)sqrt(1 - radius * radius)));
    }
    print_message("mean of the specular albedo: %.4f\n", sum / LIGHTS);
    assert_true(fabs(sum / LIGHTS - 1) < 0.02);
    weft_weave_free(&weave);
}

int test_weave_energy(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(published_fabrics_reflect_no_more_than_they_receive),
        cmocka_unit_test(an_albedo_is_linear_in_the_colours),
        cmocka_unit_test(specular_light_is_normalised_over_both_hemispheres),
    };
    return cmocka_run_group_tests_name("energy of woven cloth", tests, NULL, NULL);
}
