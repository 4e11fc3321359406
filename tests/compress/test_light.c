/* The light table. */
#include "texel_fixture.h"

#include "compress/light.h"
#include "compress/pack.h"

#include <stdlib.h>
#include <string.h>

/* A texel fitted with T, then with S beside it. */
typedef struct both_fits {
    double without, with; /* relative RMSE */
    weft_fit fit;
    double *light;
    float *cosine;
} both_fits;

static both_fits fit_both(texel_fixture *fixture, double tolerance)
{
    const weft_bundle *bundle = &fixture->bundle;
    both_fits result = {.light = calloc((size_t)bundle->light_count, sizeof(double)),
                        .cosine = aligned_alloc(64, ((size_t)bundle->sample_count + 16) * sizeof(float))};
    weft_fit_options options = weft_fit_default_options();
    options.tolerance = tolerance;
    weft_fit_cold(bundle, &fixture->samples, 0, &options, fixture->workspace, &fixture->frame, &result.fit,
                  fixture->table);
    result.without = texel_fixture_error(fixture, 0, &result.fit, fixture->table);
    for (int l = 0; l < bundle->light_count; l++)
        result.light[l] = 1;
    weft_samples lit = weft_light_refine(bundle, &fixture->samples, 0, &options, fixture->workspace, result.cosine,
                                         &result.fit, fixture->table, result.light);
    double residual = weft_fit_residual(bundle, &lit, 0, &result.fit, fixture->table);
    assert_true(fabs(residual - result.fit.residual) <= 1e-4 * residual + 1e-9 * fixture->samples.energy[0]);
    result.with = sqrt(residual / fixture->samples.energy[0]);
    return result;
}

static void free_fits(both_fits *fits)
{
    free(fits->light);
    free(fits->cosine);
}

static void it_takes_a_fifth_of_the_error_of_cloth(void **state)
{
    texel_fixture *fixture = *state;
    for (synthetic_kind kind = SYNTHETIC_WARD; kind < SYNTHETIC_KINDS; kind++) {
        double without = 0, with = 0;
        for (uint64_t texel = 0; texel < 24; texel++) {
            texel_fixture_fill(fixture, kind, 65 * texel, 0.01);
            both_fits fits = fit_both(fixture, 1e-3);
            assert_true(fits.with <= 1.001 * fits.without);
            without += fits.without;
            with += fits.with;
            free_fits(&fits);
        }
        print_message("kind %d: relative RMSE %.4f with T, %.4f with T and S\n", (int)kind, without / 24, with / 24);
        assert_true(with < 0.8 * without);
    }
}

/* Shadows of light and view on a diffuse texel: T and S alone explain it. */
static void a_separable_texel_is_explained_to_the_end(void **state)
{
    texel_fixture *fixture = *state;
    for (int image = 0; image < fixture->layout.image_count; image++) {
        weft_vec3 l = fixture->layout.light[image], v = fixture->layout.view[fixture->layout.view_of_image[image]];
        fixture->count[image] = 1;
        for (int k = 0; k < 3; k++)
            fixture->sum[3 * image + k] =
                (float)(l.z * 0.4 * (0.6 + 0.4 * sin(3 * l.x + l.y)) * (0.7 + 0.3 * cos(2 * v.x - v.y)));
    }
    texel_fixture_gather(fixture);
    both_fits fits = fit_both(fixture, 1e-9);
    assert_true(fits.without > 0.05);
    assert_true(fits.with < 2e-3);
    free_fits(&fits);
}

static void lights_are_labelled_once_and_rare_ones_join_the_nearest(void **state)
{
    texel_fixture *fixture = *state;
    weft_dataset_layout layout = fixture->layout;
    weft_bundle bundle;
    weft_error error;
    weft_vec3 *kept = layout.light;
    assert_int_equal(fixture->bundle.light_count, 81);
    layout.light = malloc((size_t)layout.image_count * sizeof *layout.light);
    memcpy(layout.light, kept, (size_t)layout.image_count * sizeof *layout.light);
    layout.light[100] = weft_unit(weft_vec3_of(kept[100].x + 0.01, kept[100].y, kept[100].z));
    assert_int_equal(weft_bundle_create(&layout, NULL, &bundle, &error), WEFT_OK);
    assert_int_equal(bundle.light_count, 81);
    for (int i = 0; i < bundle.sample_count; i++) {
        if (bundle.image[i] >= 0)
            assert_true(weft_dot(bundle.distinct[bundle.light_of[i]], layout.light[bundle.image[i]]) > 0.9998);
    }
    weft_bundle_free(&bundle);
    free(layout.light);
}

static void masked_lights_keep_the_mean_of_the_others(void **state)
{
    texel_fixture *fixture = *state;
    texel_fixture_fill(fixture, SYNTHETIC_WARD, 3, 0.01);
    int hidden = fixture->bundle.light_of[0];
    for (int i = 0; i < fixture->bundle.sample_count; i++) {
        if (fixture->bundle.image[i] >= 0 && fixture->bundle.light_of[i] == hidden)
            fixture->count[fixture->bundle.image[i]] = 0;
    }
    texel_fixture_gather(fixture);
    both_fits fits = fit_both(fixture, 1e-3);
    for (int l = 0; l < fixture->bundle.light_count; l++)
        assert_true(isfinite(fits.light[l]) && fits.light[l] >= 0);
    assert_true(fabs(fits.light[hidden] - 1) < 0.5);
    free_fits(&fits);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(it_takes_a_fifth_of_the_error_of_cloth, texel_fixture_setup,
                                        texel_fixture_teardown),
        cmocka_unit_test_setup_teardown(a_separable_texel_is_explained_to_the_end, texel_fixture_setup,
                                        texel_fixture_teardown),
        cmocka_unit_test_setup_teardown(lights_are_labelled_once_and_rare_ones_join_the_nearest, texel_fixture_setup,
                                        texel_fixture_teardown),
        cmocka_unit_test_setup_teardown(masked_lights_keep_the_mean_of_the_others, texel_fixture_setup,
                                        texel_fixture_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
