/* The tabulated means of a weave against its texture. */
#include "../reflectance/random.h"
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

static weft_vec3 direction(int index)
{
    return weft_direction_of_angles(weft_ubo81_angles(index));
}

static void means_are_within_a_thousandth(void **state)
{
    static const char *const name[] = {"wool_gabardine", "silk_charmeuse"};
    (void)state;
    for (int k = 0; k < 2; k++) {
        weft_weave weave;
        weft_weave_texels texels;
        read(name[k], &weave, &texels);
        for (int i = 0; i < WEFT_UBO81_COUNT * WEFT_UBO81_COUNT; i += 7) {
            weft_rgb exact =
                weft_weave_mean_brdf(&weave, direction(i % WEFT_UBO81_COUNT), direction(i / WEFT_UBO81_COUNT));
            assert_true(fabs((double)texels.mean[i][0] - exact.r) <= 1e-3 * exact.r);
            assert_true(fabs((double)texels.mean[i][2] - exact.b) <= 1e-3 * exact.b);
        }
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
        int light = pair[k / 2][0], view = pair[k / 2][1], texel = view * WEFT_UBO81_COUNT + light;
        double expected = texture_mean(&weave, direction(light), direction(view), 42);
        double noisy = (double)texels.noisy_mean[texel][0], plain = (double)texels.mean[texel][0];
        print_message("%s: texture %.5f, table %.5f, without noise %.5f\n", name[k % 2], expected, noisy, plain);
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
    assert_true(texels.has_noise && !texels.noisy_mean);
    weft_weave_texels_free(&texels);
    weft_weave_free(&weave);
    read("wool_gabardine", &weave, &texels);
    assert_true(!texels.has_noise && !texels.noisy_mean);
    weft_weave_texels_free(&texels);
    weft_weave_free(&weave);
}

int test_weave_texels(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(means_are_within_a_thousandth),
        cmocka_unit_test(under_noise_the_mean_is_that_of_the_noisy_texture),
        cmocka_unit_test(cloth_without_inclination_noise_has_one_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
