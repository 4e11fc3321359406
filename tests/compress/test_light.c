/* The light table. */
#include "texel_fixture.h"

#include "compress/fit/light_table.h"
#include "compress/texel/pack.h"
#include "tests/support/alternation.h"

#include <stdlib.h>
#include <string.h>

/* A texel fitted with T, then with S beside it. */
typedef struct both_fits {
    double without, with; /* relative RMSE */
    weft_fit fit;
    double *light;
    weft_light_workspace own;
} both_fits;

/* The frame of the surface; turned for T where `turned`, then once more with S where `turns_with_light`. */
static both_fits fit_both(texel_fixture *fixture, double tolerance, bool turned, bool turns_with_light)
{
    const weft_bundle *bundle = &fixture->bundle;
    weft_error error;
    both_fits result = {.light = calloc((size_t)bundle->light_count, sizeof(double))};
    assert_int_equal(weft_light_workspace_create(bundle, &result.own, &error), WEFT_OK);
    weft_fit_options options = weft_fit_default_options();
    options.tolerance = tolerance;
    options.fit_frame = turned;
    weft_fit_cold(bundle, &fixture->samples, 0, &options, fixture->workspace, &fixture->frame, &result.fit,
                  fixture->table);
    result.without = texel_fixture_error(fixture, 0, &result.fit, fixture->table);
    for (int l = 0; l < bundle->light_count; l++)
        result.light[l] = 1;
    options.fit_frame = turns_with_light;
    weft_samples lit = weft_light_refine(bundle, &fixture->samples, 0, &options, 12, fixture->workspace, &result.own,
                                         &result.fit, fixture->table, result.light);
    double residual = weft_fit_residual(bundle, &lit, 0, &result.fit, fixture->table);
    assert_true(fabs(residual - result.fit.residual) <= 1e-4 * residual + 1e-9 * fixture->samples.energy[0]);
    result.with = sqrt(residual / fixture->samples.energy[0]);
    return result;
}

static void free_fits(both_fits *fits)
{
    free(fits->light);
    weft_light_workspace_free(&fits->own);
}

static void it_takes_a_fifth_of_the_error_of_cloth(void **state)
{
    texel_fixture *fixture = *state;
    for (synthetic_kind kind = SYNTHETIC_WARD; kind < SYNTHETIC_KINDS; kind++) {
        double without = 0, with = 0;
        for (uint64_t texel = 0; texel < 24; texel++) {
            texel_fixture_fill(fixture, kind, 65 * texel, 0.01);
            both_fits fits = fit_both(fixture, 1e-3, false, false);
            assert_true(fits.with <= 1.001 * fits.without);
            without += fits.without;
            with += fits.with;
            free_fits(&fits);
        }
        print_message("kind %d: relative RMSE %.4f with T, %.4f with T and S\n", (int)kind, without / 24, with / 24);
        assert_true(with < 0.8 * without);
    }
}

/* Without S the frame turns towards where the light is, too. */
static void with_it_the_frame_turns_once_more(void **state)
{
    texel_fixture *fixture = *state;
    double before = 0, after = 0;
    for (synthetic_kind kind = SYNTHETIC_WARD; kind < SYNTHETIC_KINDS; kind++) {
        for (uint64_t texel = 0; texel < 12; texel++) {
            texel_fixture_fill(fixture, kind, 65 * texel, 0.01);
            both_fits still = fit_both(fixture, 1e-3, true, false), turns = fit_both(fixture, 1e-3, true, true);
            before += still.with / still.without;
            after += turns.with / turns.without;
            free_fits(&still);
            free_fits(&turns);
        }
    }
    print_message("what S leaves of the error in the frame fitted without it %.3f, in its own %.3f\n", before / 24,
                  after / 24);
    assert_true(after < 0.93 * before);
}

/* What would be left if T were clamped to at most 16 times its mean and at least 1/16 of it, both weighted by what they
 * explain, over what is left. */
static double loss_at_contrast(const texel_fixture *fixture, const both_fits *fits)
{
    const weft_bundle *bundle = &fixture->bundle;
    weft_samples lit = weft_light_apply(bundle, &fixture->samples, fits->light, fits->own.cosine);
    const float *model = weft_fit_evaluate(bundle, &lit, fixture->workspace, &fits->fit);
    double sum = 0, weight = 0, clamped[WEFT_MATERIAL_MAX_VIEWS];
    for (int i = 0; i < bundle->sample_count; i++) {
        double t = fixture->table[bundle->view_of[i]], explained = pow(t * (double)model[i], 2);
        sum += explained > 0 ? explained * log(t) : 0;
        weight += explained;
    }
    double mean = exp(sum / weight);
    for (int view = 0; view < bundle->view_count; view++)
        clamped[view] = fmin(fmax(fixture->table[view], mean / 16), mean * 16);
    return weft_fit_residual(bundle, &lit, 0, &fits->fit, clamped) /
           weft_fit_residual(bundle, &lit, 0, &fits->fit, fixture->table);
}

/* A yarn whose highlight is a band with hard edges: a lobe that is sharp and far away, made up for by T, leaves least.
 */
static void it_keeps_a_moderate_contrast_between_views(void **state)
{
    texel_fixture *fixture = *state;
    const weft_vec3 along = weft_unit(weft_vec3_of(1, 0.3, 0.5));
    for (int image = 0; image < fixture->layout.image_count; image++) {
        weft_vec3 l = fixture->layout.light[image], v = fixture->layout.view[fixture->layout.view_of_image[image]];
        weft_vec3 half = weft_unit(weft_add(l, v));
        fixture->count[image] = 1;
        for (int k = 0; k < 3; k++)
            fixture->sum[3 * image + k] = (float)(l.z * (fabs(weft_dot(half, along)) < 0.12 ? 1 : 0.002));
    }
    texel_fixture_gather(fixture);
    both_fits fits = fit_both(fixture, 1e-4, true, true);
    print_message("relative RMSE %.4f with T, %.4f with T and S; clamped %.3f times the squared error\n", fits.without,
                  fits.with, loss_at_contrast(fixture, &fits));
    assert_true(fits.with < fits.without);
    assert_true(loss_at_contrast(fixture, &fits) < 1.2);
    free_fits(&fits);
}

/* A highlight where the half vector is nearly perpendicular to (1, y, z). */
typedef struct band {
    bool hard; /* its edges; else Gaussian */
    double y, z, width, dark;
} band;

static void fill_band(texel_fixture *fixture, const band *b)
{
    const weft_vec3 along = weft_unit(weft_vec3_of(1, b->y, b->z));
    for (int image = 0; image < fixture->layout.image_count; image++) {
        weft_vec3 l = fixture->layout.light[image], v = fixture->layout.view[fixture->layout.view_of_image[image]];
        double away = weft_dot(weft_unit(weft_add(l, v)), along) / b->width;
        double value = b->hard ? (fabs(away) < 1 ? 1 : b->dark) : exp(-away * away) + b->dark;
        fixture->count[image] = 1;
        for (int k = 0; k < 3; k++)
            fixture->sum[3 * image + k] = (float)(l.z * value);
    }
    texel_fixture_gather(fixture);
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Without the bound on the contrast the median of these is above 2, and some are above 4. */
static void most_bands_keep_a_moderate_contrast(void **state)
{
    static const band bands[] = {
        {true, 0.49, 0.15, 0.143, 0.0015},  {false, 0.21, 0.51, 0.127, 0.0006},  {true, -0.38, 0.15, 0.128, 0.0015},
        {true, -0.85, 0.04, 0.075, 0.0055}, {false, -0.52, 0.35, 0.145, 0.0002}, {false, 0.16, 0.47, 0.162, 0.0001},
        {false, 0.34, 0.09, 0.157, 0.0084}, {true, -0.25, 0.02, 0.164, 0.0016},  {true, -0.37, 0.24, 0.143, 0.0001},
    };
    enum { COUNT = sizeof bands / sizeof *bands };
    texel_fixture *fixture = *state;
    double loss[COUNT];
    for (int i = 0; i < COUNT; i++) {
        fill_band(fixture, &bands[i]);
        both_fits fits = fit_both(fixture, 1e-4, true, true);
        loss[i] = loss_at_contrast(fixture, &fits);
        free_fits(&fits);
    }
    qsort(loss, COUNT, sizeof *loss, ascending);
    print_message("clamped %.3f times the squared error in the median, %.3f at worst\n", loss[COUNT / 2],
                  loss[COUNT - 1]);
    assert_true(loss[COUNT / 2] < 1.3);
}

enum { LIGHTS = 7, VIEWS = 32 };

/* One round of T, then of S, in double. */
static void separate_plainly(const weft_separable *own, const float *light, double *table, double *solved)
{
    double energy[LIGHTS] = {0}, product[LIGHTS] = {0}, total = 0;
    for (int v = 0; v < VIEWS; v++) {
        double up = 0, down = 0;
        for (int l = 0; l < LIGHTS; l++) {
            up += (double)(light[l] * own->product[l * VIEWS + v]);
            down += (double)(light[l] * light[l] * own->square[l * VIEWS + v]);
        }
        table[v] = down > 0 ? fmax(0, up / down) : 1;
    }
    for (int l = 0; l < LIGHTS; l++) {
        for (int v = 0; v < VIEWS; v++) {
            product[l] += table[v] * (double)own->product[l * VIEWS + v];
            energy[l] += table[v] * table[v] * (double)own->square[l * VIEWS + v];
        }
        total += energy[l];
    }
    double prior = (double)own->prior * total / LIGHTS;
    for (int l = 0; l < LIGHTS; l++)
        solved[l] = fmax(0, product[l] + prior) / (energy[l] + prior);
}

static void every_instruction_set_solves_for_T_and_S_alike(void **state)
{
    (void)state;
    _Alignas(64) float square[LIGHTS * VIEWS] = {0}, product[LIGHTS * VIEWS] = {0}, table[VIEWS];
    const weft_separable own = {LIGHTS, VIEWS, square, product, 0.01f};
    for (int l = 0; l < LIGHTS; l++) {
        for (int v = 0; v < VIEWS - 5; v++) { /* the last views are padding */
            square[l * VIEWS + v] = l == 3 ? 0 : 1 + (float)sin(3.0 * l + v);
            product[l * VIEWS + v] = square[l * VIEWS + v] * (float)(l == 5 ? -1 : 0.5 + 0.4 * cos(l + 2.0 * v));
        }
    }
    for (weft_instruction_set set = WEFT_BASELINE; set <= weft_processor_best(); set++) {
        float light[LIGHTS] = {1, 2, 1, 1, 0.5f, 1, 3}, energy[LIGHTS];
        double expected_table[VIEWS], expected[LIGHTS];
        separate_plainly(&own, light, expected_table, expected);
        weft_fit_kernels_of(set)->separate(&own, true, 1, table, light, energy);
        for (int v = 0; v < VIEWS; v++)
            assert_true(fabs((double)table[v] - expected_table[v]) < 1e-5);
        for (int l = 0; l < LIGHTS; l++)
            assert_true(fabs((double)light[l] - expected[l]) < 1e-5);
        assert_true(light[3] == 1 && light[5] == 0);
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
    both_fits fits = fit_both(fixture, 1e-9, false, false);
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
    both_fits fits = fit_both(fixture, 1e-3, false, false);
    for (int l = 0; l < fixture->bundle.light_count; l++)
        assert_true(isfinite(fits.light[l]) && fits.light[l] >= 0);
    assert_true(fabs(fits.light[hidden] - 1) < 0.5);
    free_fits(&fits);
}

int test_light(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(it_takes_a_fifth_of_the_error_of_cloth, texel_fixture_setup,
                                        texel_fixture_teardown),
        cmocka_unit_test_setup_teardown(with_it_the_frame_turns_once_more, texel_fixture_setup, texel_fixture_teardown),
        cmocka_unit_test_setup_teardown(it_keeps_a_moderate_contrast_between_views, texel_fixture_setup,
                                        texel_fixture_teardown),
        cmocka_unit_test_setup_teardown(most_bands_keep_a_moderate_contrast, texel_fixture_setup,
                                        texel_fixture_teardown),
        cmocka_unit_test(every_instruction_set_solves_for_T_and_S_alike),
        cmocka_unit_test_setup_teardown(a_separable_texel_is_explained_to_the_end, texel_fixture_setup,
                                        texel_fixture_teardown),
        cmocka_unit_test_setup_teardown(lights_are_labelled_once_and_rare_ones_join_the_nearest, texel_fixture_setup,
                                        texel_fixture_teardown),
        cmocka_unit_test_setup_teardown(masked_lights_keep_the_mean_of_the_others, texel_fixture_setup,
                                        texel_fixture_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
