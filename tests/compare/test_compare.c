#include "base/atomic_file.h"
#include "base/numeric/statistics.h"
#include "btf/direction/direction.h"
#include "compare/report/compare.h"
#include "reflectance/microcylinder/file.h"
#include "tests/compare/fixture.h"
#include "tests/support/suite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 5, HEIGHT = 4, SIDE = 120 /* of the pictures */ };

static weft_rgb glossy(int x, int y, weft_vec3 light, weft_vec3 view)
{
    weft_real mirror = light.z * view.z - light.x * view.x - light.y * view.y;
    weft_real lobe = mirror > 0 ? 0.4 * pow(mirror, 6) : 0;
    return (weft_rgb){0.2 + 0.05 * x + lobe, 0.15 + 0.05 * y + lobe, 0.1 + lobe};
}

static weft_rgb flat(int x, int y)
{
    return (weft_rgb){0.25 + 0.05 * x, 0.2 + 0.05 * y, 0.15};
}

/* The error of `flat` against `glossy` straight from the two functions. */
static weft_error_summary expected_error(int ring)
{
    static double relative[WIDTH * HEIGHT * 361 * 3];
    long count = 0;
    double squares = 0, errors = 0;
    for (int pair = 0; pair < 19 * 19; pair++) {
        weft_vec3 view = weft_direction_of_angles(weft_ubo81_angles(pair / 19));
        weft_vec3 light = weft_direction_of_angles(weft_ubo81_angles(pair % 19));
        if (ring >= 0 && weft_ubo81_ring(weft_ubo81_angles(pair / 19).theta_rad) != ring)
            continue;
        for (int texel = (pair == 0); texel < WIDTH * HEIGHT; texel++) {
            weft_rgb s = glossy(texel % WIDTH, texel / WIDTH, light, view), p = flat(texel % WIDTH, texel / WIDTH);
            const double sample[3] = {s.r * light.z, s.g * light.z, s.b * light.z};
            const double prediction[3] = {p.r * light.z, p.g * light.z, p.b * light.z};
            for (int c = 0; c < 3; c++) {
                squares += sample[c] * sample[c];
                errors += (sample[c] - prediction[c]) * (sample[c] - prediction[c]);
                relative[count++] = fabs(sample[c] - prediction[c]) / sample[c];
            }
        }
    }
    return (weft_error_summary){.median_relative = weft_quantile(relative, (size_t)count, 0.5),
                                .percentile80_relative = weft_quantile(relative, (size_t)count, 0.8),
                                .relative_rmse = sqrt(errors / squares),
                                .count = count};
}

/* The same of the means over the texels, without the cosine. */
static weft_error_summary expected_mean_error(void)
{
    static double relative[361 * 3];
    long count = 0;
    double squares = 0, errors = 0;
    for (int pair = 0; pair < 19 * 19; pair++) {
        weft_vec3 view = weft_direction_of_angles(weft_ubo81_angles(pair / 19));
        weft_vec3 light = weft_direction_of_angles(weft_ubo81_angles(pair % 19));
        double sample[3] = {0}, prediction[3] = {0};
        for (int texel = 0; texel < WIDTH * HEIGHT; texel++) {
            weft_rgb s = glossy(texel % WIDTH, texel / WIDTH, light, view), p = flat(texel % WIDTH, texel / WIDTH);
            double valid = pair == 0 && texel == 0 ? 0 : 1;
            sample[0] += valid * s.r, sample[1] += valid * s.g, sample[2] += valid * s.b;
            prediction[0] += p.r, prediction[1] += p.g, prediction[2] += p.b;
        }
        for (int c = 0; c < 3; c++) {
            double s = sample[c] / (WIDTH * HEIGHT - (pair == 0)), p = prediction[c] / (WIDTH * HEIGHT);
            squares += s * s;
            errors += (s - p) * (s - p);
            relative[count++] = fabs(s - p) / s;
        }
    }
    return (weft_error_summary){.median_relative = weft_quantile(relative, (size_t)count, 0.5),
                                .percentile80_relative = weft_quantile(relative, (size_t)count, 0.8),
                                .relative_rmse = sqrt(errors / squares),
                                .count = count};
}

static char *read_page(const char *path)
{
    char *text;
    size_t size;
    weft_error error = {0};
    expect_ok(weft_read_file(path, 1 << 24, &text, &size, &error), &error);
    return text;
}

static void expect_error(const weft_error_summary *measured, const weft_error_summary *expected)
{
    assert_int_equal(measured->count, expected->count);
    assert_float_equal(measured->relative_rmse, expected->relative_rmse, 2e-3 * expected->relative_rmse);
    assert_float_equal(measured->median_relative, expected->median_relative, 5e-3 * expected->median_relative);
    assert_float_equal(measured->percentile80_relative, expected->percentile80_relative,
                       5e-3 * expected->percentile80_relative);
}

static void the_page_tells_the_errors_that_the_functions_have(void **state)
{
    (void)state;
    fixture_far_dataset("compare.btf.h5", WIDTH, HEIGHT, 3, glossy, FIXTURE_MASK_ONE);
    fixture_diffuse_material("compare.weft", WIDTH, HEIGHT, flat);
    const weft_compare_options options = {
        .dataset = "compare.btf.h5", .material = "compare.weft", .folder = "compare-report"};
    weft_comparison comparison;
    weft_error error = {0};
    expect_ok(weft_compare(&options, NULL, &comparison, &error), &error);
    weft_error_summary all = expected_error(-1), ring = expected_error(2), mean = expected_mean_error();
    assert_int_equal(comparison.model_count, 1);
    expect_error(&comparison.model[0].mean, &mean);
    expect_error(&comparison.model[0].texture.all, &all);
    expect_error(&comparison.model[0].texture.by_view[2], &ring);
    assert_int_equal(comparison.model[0].texture.by_view[4].count, 0);
    assert_int_equal(comparison.model[0].texture.saturated, 1);
    char *page = read_page("compare-report/index.html"), row[128];
    const weft_error_summary *m = &comparison.model[0].texture.all;
    snprintf(row, sizeof row, "<td>all</td><td>%ld</td><td>%.2f %%</td><td>%.2f %%</td>", m->count,
             100 * m->relative_rmse, 100 * m->median_relative);
    assert_non_null(strstr(page, row));
    snprintf(row, sizeof row, "<title>compressed, 30\u00b0: %.4g %%</title>",
             100 * comparison.model[0].texture.by_view[2].relative_rmse);
    assert_non_null(strstr(strstr(page, "Error by view"), row));
    assert_int_equal(access("compare-report/texels-2-compressed-difference.png", R_OK), 0);
    assert_true((strstr(page, "There are no pictures of scenes") != NULL) == !comparison.scenes.drawn);
    free(page);
    weft_comparison_free(&comparison);
}

/* A row of the table of models. */
static void expect_model_row(const char *page, const char *name, const weft_error_summary *e)
{
    char row[160];
    snprintf(row, sizeof row, "<td>%s</td><td>%ld</td><td>%.2f %%</td><td>%.2f %%</td><td>%.2f %%</td>", name, e->count,
             100 * e->relative_rmse, 100 * e->median_relative, 100 * e->percentile80_relative);
    if (!strstr(page, row))
        fail_msg("the page has no row %s", row);
}

/* The error of the analytic cloth, sample by sample: laid as the fit found it, or as many tiles from the corner.
 * `weave` is the start of the fit, or what an earlier one found. */
static weft_error_summary compare_weave(const char *weave, bool fit, double tiles, bool on_yarns)
{
    const weft_compare_options options = {.dataset = "compare.btf.h5",
                                          .material = "compare.weft",
                                          .weave = weave,
                                          .fit = fit,
                                          .tiles_u = tiles,
                                          .tiles_v = tiles,
                                          .folder = "compare-report"};
    weft_comparison comparison;
    weft_error error = {0};
    expect_ok(weft_compare(&options, NULL, &comparison, &error), &error);
    weft_error_summary result = comparison.model[1].texture.all;
    char *page = read_page("compare-report/index.html");
    assert_int_equal(comparison.weave_on_yarns, on_yarns);
    assert_int_equal(strstr(page, "placed by the fit") != NULL, on_yarns);
    free(page);
    const weft_weave_layout *layout = &comparison.weave_layout;
    print_message("%.3f x %.3f tiles, corner at %.3f, %.3f: relative RMSE %.4f\n", layout->tiles_u, layout->tiles_v,
                  layout->corner_u, layout->corner_v, result.relative_rmse);
    weft_comparison_free(&comparison);
    return result;
}

static void a_fitted_weave_lies_with_its_yarns_on_those_of_the_data(void **state)
{
    (void)state;
    enum { TEXELS = 40 };
    const double tile = 16.6;
    weft_error error = {0};
    fixture_cloth = (fixture_weave){.width = tile, .height = tile, .left = 5.2, .top = 9.7};
    expect_ok(weft_weave_read(WEFT_ASSETS "/weaves/polyester_lining.wv", NULL, 0, &fixture_cloth.weave, NULL, &error),
              &error);
    fixture_far_dataset("compare.btf.h5", TEXELS, TEXELS, 3, fixture_woven, FIXTURE_MASK_NONE);
    fixture_diffuse_material("compare.weft", TEXELS, TEXELS, flat);
    const char *start = WEFT_ASSETS "/weaves/polyester_lining.wv";
    weft_error_summary laid = compare_weave(start, true, 0, true);
    assert_int_equal(rename("compare-report/fitted.wv", "fitted.wv"), 0);
    weft_error_summary kept = compare_weave("fitted.wv", false, 0, true);
    weft_error_summary beside = compare_weave("fitted.wv", false, TEXELS / tile, false);
    assert_true(laid.relative_rmse < 0.25 * beside.relative_rmse);
    assert_float_equal(kept.relative_rmse, laid.relative_rmse, 1e-9);
    weft_weave_free(&fixture_cloth.weave);
}

/* The dataset itself in place of a prediction has no error; a weave that is not its cloth has. */
static void the_page_compares_every_model_that_is_given(void **state)
{
    (void)state;
    fixture_far_dataset("compare.btf.h5", WIDTH, HEIGHT, 3, glossy, FIXTURE_MASK_ONE);
    fixture_diffuse_material("compare.weft", WIDTH, HEIGHT, flat);
    const weft_compare_options options = {.dataset = "compare.btf.h5",
                                          .material = "compare.weft",
                                          .weave = WEFT_ASSETS "/weaves/cotton_denim.wv",
                                          .bard = "compare.btf.h5",
                                          .picture_side = SIDE,
                                          .folder = "compare-report"};
    weft_comparison comparison;
    weft_error error = {0};
    expect_ok(weft_compare(&options, NULL, &comparison, &error), &error);
    char *page = read_page("compare-report/index.html");
    assert_int_equal(comparison.model_count, 3);
    for (int i = 0; i < 3; i++) {
        expect_model_row(page, comparison.model[i].name, &comparison.model[i].texture.all);
        expect_model_row(page, comparison.model[i].name, &comparison.model[i].mean);
    }
    assert_true(comparison.model[1].texture.all.relative_rmse > 0.1);
    assert_true(comparison.model[1].mean.relative_rmse > 0.1);
    assert_true(comparison.model[2].texture.all.relative_rmse == 0);
    assert_float_equal(comparison.model[2].mean.relative_rmse, 0, 1e-6);
    if (comparison.scenes.drawn) {
        assert_int_equal(comparison.scenes.scene[0].picture[WEFT_MODE_RAW].width, SIDE);
        assert_true(comparison.scenes.scene[0].error[WEFT_SCENE_BARD].relative_rmse == 0);
        assert_true(comparison.scenes.scene[0].error[WEFT_MODE_ANALYTIC].relative_rmse > 0.1);
    }
    assert_non_null(strstr(page, "as its file gives it"));
    assert_int_equal(access("compare-report/slices-3.png", R_OK), 0);
    assert_int_equal(access("compare-report/texels-1-BARD-difference.png", R_OK), 0);
    free(page);
    weft_comparison_free(&comparison);
}

static weft_prepared_cloth threads;

static weft_rgb threaded(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)x, (void)y;
    weft_rgb brdf = weft_microcylinder_brdf(&threads, WEFT_CLOTH_BY_AREA, light, view);
    return (weft_rgb){WEFT_PI * brdf.r, WEFT_PI * brdf.g, WEFT_PI * brdf.b};
}

/* A dataset of the cloth itself: only half floats lie between. */
static void microcylinder_cloth_is_compared_as_it_is(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_microcylinder_description description;
    weft_compare_options options = {.dataset = "compare.btf.h5",
                                    .material = "compare.weft",
                                    .weave = WEFT_ASSETS "/microcylinder/shot.mc",
                                    .picture_side = SIDE,
                                    .folder = "compare-report"};
    expect_ok(weft_microcylinder_read(options.weave, NULL, 0, &description, &error), &error);
    threads = weft_microcylinder_prepare(&description.cloth);
    fixture_far_dataset("compare.btf.h5", WIDTH, HEIGHT, 6, threaded, FIXTURE_MASK_NONE);
    fixture_diffuse_material("compare.weft", WIDTH, HEIGHT, flat);
    weft_comparison comparison;
    expect_ok(weft_compare(&options, NULL, &comparison, &error), &error);
    char *page = read_page("compare-report/index.html");
    assert_int_equal(comparison.model_count, 2);
    assert_true(comparison.model[1].texture.all.count > 0);
    assert_true(comparison.model[1].texture.all.relative_rmse < 1e-3);
    assert_true(comparison.model[1].mean.relative_rmse < 1e-3);
    assert_true(comparison.model[0].texture.all.relative_rmse > 0.1);
    assert_non_null(strstr(page, "The analytic cloth is the microcylinder cloth"));
    const weft_error_summary *drawn = comparison.scenes.scene[0].error;
    print_message("drawn against raw: analytic %.4f, compressed %.4f\n", drawn[WEFT_MODE_ANALYTIC].relative_rmse,
                  drawn[WEFT_MODE_COMPRESSED].relative_rmse);
    if (comparison.scenes.drawn)
        assert_true(drawn[WEFT_MODE_ANALYTIC].relative_rmse < 0.1);
    free(page);
    weft_comparison_free(&comparison);
    options.fit = true;
    assert_int_equal(weft_compare(&options, NULL, &comparison, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, "shot.mc' is microcylinder cloth"));
}

static void nothing_is_done(void *context, const char *stage, long done, long total)
{
    (void)context, (void)done, (void)total;
    fail_msg("%s before the files are looked at", stage);
}

static void a_prediction_of_another_dataset_is_refused_before_work(void **state)
{
    (void)state;
    const weft_progress progress = {.report = nothing_is_done};
    fixture_far_dataset("compare.btf.h5", WIDTH, HEIGHT, 2, glossy, FIXTURE_MASK_NONE);
    fixture_far_dataset("other.btf.h5", WIDTH + 1, HEIGHT, 2, glossy, FIXTURE_MASK_NONE);
    fixture_diffuse_material("compare.weft", WIDTH, HEIGHT, flat);
    const weft_compare_options options = {
        .dataset = "compare.btf.h5", .material = "compare.weft", .bard = "other.btf.h5", .folder = "no-report"};
    weft_comparison comparison;
    weft_error error = {0};
    assert_int_equal(weft_compare(&options, &progress, &comparison, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "other.btf.h5"));
    assert_int_not_equal(access("no-report/index.html", F_OK), 0);
}

static weft_rgb matt(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)light, (void)view;
    return (weft_rgb){0.2 + 0.05 * x, 0.3, 0.5 - 0.05 * y};
}

static weft_rgb black(int x, int y)
{
    (void)x, (void)y;
    return (weft_rgb){0, 0, 0};
}

static void a_material_of_another_size_is_refused(void **state)
{
    (void)state;
    fixture_near_dataset("compare.btf.h5", 4, 3, matt);
    fixture_diffuse_material("compare.weft", 5, 4, black);
    const weft_compare_options options = {
        .dataset = "compare.btf.h5", .material = "compare.weft", .folder = "no-report"};
    weft_comparison comparison;
    weft_error error = {0};
    assert_int_equal(weft_compare(&options, NULL, &comparison, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "4 x 4"));
    assert_non_null(strstr(error.message, "5 x 4"));
    assert_int_not_equal(access("no-report/index.html", F_OK), 0);
}

/* --drawn: those whose scenes are looked at, too. */
int test_compare(void)
{
    const struct CMUnitTest drawn[] = {
        cmocka_unit_test(the_page_compares_every_model_that_is_given),
        cmocka_unit_test(microcylinder_cloth_is_compared_as_it_is),
    };
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_page_tells_the_errors_that_the_functions_have),
        cmocka_unit_test(the_page_compares_every_model_that_is_given),
        cmocka_unit_test(a_fitted_weave_lies_with_its_yarns_on_those_of_the_data),
        cmocka_unit_test(microcylinder_cloth_is_compared_as_it_is),
        cmocka_unit_test(a_prediction_of_another_dataset_is_refused_before_work),
        cmocka_unit_test(a_material_of_another_size_is_refused),
    };
    if (suite_argument && strcmp(suite_argument, "drawn") == 0)
        return cmocka_run_group_tests(drawn, NULL, NULL);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
