/* The mean of a weave as it is drawn, against the exact one and against its texture. */
#include "../reflectance/random.h"
#include "btf/direction/direction.h"
#include "player/texture/weave_texels.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdio.h>

static void read(const char *name, weft_weave *weave, weft_weave_texels *texels)
{
    char path[512];
    weft_error error = {0};
    snprintf(path, sizeof path, "%s/weaves/%s.wv", WEFT_ASSETS, name);
    if (weft_weave_read(path, NULL, 0, weave, NULL, &error) != WEFT_OK ||
        weft_weave_texels_of(weave, texels, &error) != WEFT_OK)
        fail_msg("%s", error.message);
}

/* Uniform in both angles, within 85 degrees of the normal. */
static weft_vec3 direction(uint64_t *random)
{
    weft_real theta = weft_rad_of_deg(random_between(random, 0, 85));
    return weft_direction_of_angles((weft_angles){theta, random_between(random, 0, 2 * WEFT_PI)});
}

/* Relative RMSE over pairs of directions, all channels. */
static double error_of(const weft_weave *weave, const weft_weave_means *means)
{
    enum { PAIRS = 1500 };
    uint64_t random = 3;
    double error = 0, size = 0;
    for (int i = 0; i < PAIRS; i++) {
        weft_vec3 light = direction(&random), view = direction(&random);
        weft_rgb exact = weft_weave_mean_brdf(weave, light, view),
                 drawn = weft_weave_tabulated_mean(means, light, view);
        const double difference[3] = {drawn.r - exact.r, drawn.g - exact.g, drawn.b - exact.b};
        for (int c = 0; c < 3; c++)
            error += difference[c] * difference[c];
        size += exact.r * exact.r + exact.g * exact.g + exact.b * exact.b;
    }
    return sqrt(error / size);
}

static void the_mean_of_every_cloth_is_right_to_the_horizon(void **state)
{
    static const char *const name[] = {"cotton_denim",   "cotton_twill",  "polyester_lining",
                                       "silk_charmeuse", "silk_shantung", "wool_gabardine"};
    (void)state;
    for (int k = 0; k < 6; k++) {
        weft_weave weave;
        weft_weave_texels texels;
        read(name[k], &weave, &texels);
        double error = error_of(&weave, &texels.means);
        print_message("%s: %.3f %%\n", name[k], 100 * error);
        assert_true(error < (weave.yarn[0].segment.psi == 0 ? 0.002 : 0.015));
        weft_weave_texels_free(&texels);
        weft_weave_free(&weave);
    }
}

/* Mean of the texture over places of a large cloth. */
static double texture_mean(const weft_weave *weave, weft_vec3 light, weft_vec3 view, uint64_t seed)
{
    enum { COUNT = 400000 };
    uint64_t random = 5;
    double sum = 0;
    for (int i = 0; i < COUNT; i++) {
        weft_weave_point point =
            weft_weave_locate(weave, random_between(&random, -4e4, 4e4), random_between(&random, -4e4, 4e4), seed);
        sum += weft_weave_brdf(weave, &point, light, view).r;
    }
    return sum / COUNT;
}

static void under_noise_the_mean_is_that_of_the_noisy_texture(void **state)
{
    static const char *const name[] = {"silk_shantung", "polyester_lining"};
    static const int pair[][2] = {{0, 0}, {9, 30}, {40, 3}};
    (void)state;
    double largest_change = 0;
    for (int k = 0; k < 6; k++) {
        weft_weave weave;
        weft_weave_texels texels;
        read(name[k % 2], &weave, &texels);
        weft_vec3 light = weft_direction_of_angles(weft_ubo81_angles(pair[k / 2][0]));
        weft_vec3 view = weft_direction_of_angles(weft_ubo81_angles(pair[k / 2][1]));
        double expected = texture_mean(&weave, light, view, 42);
        double noisy = weft_weave_tabulated_mean(&texels.noisy_means, light, view).r;
        double plain = weft_weave_tabulated_mean(&texels.means, light, view).r;
        print_message("%s: texture %.5f, drawn %.5f, without noise %.5f\n", name[k % 2], expected, noisy, plain);
        assert_true(fabs(noisy / expected - 1) < 0.02);
        largest_change = fmax(largest_change, fabs(plain / expected - 1));
        weft_weave_texels_free(&texels);
        weft_weave_free(&weave);
    }
    assert_true(largest_change > 0.04);
}

static void cloth_without_inclination_noise_has_one_mean(void **state)
{
    weft_weave weave;
    weft_weave_texels texels;
    (void)state;
    read("cotton_denim", &weave, &texels);
    assert_true(texels.has_noise && !texels.noisy_means.texel);
    weft_weave_texels_free(&texels);
    weft_weave_free(&weave);
    read("wool_gabardine", &weave, &texels);
    assert_true(!texels.has_noise && !texels.noisy_means.texel);
    weft_weave_texels_free(&texels);
    weft_weave_free(&weave);
}

int test_weave_texels(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mean_of_every_cloth_is_right_to_the_horizon),
        cmocka_unit_test(under_noise_the_mean_is_that_of_the_noisy_texture),
        cmocka_unit_test(cloth_without_inclination_noise_has_one_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
