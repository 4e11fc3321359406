#include "btf/atomic_file.h"
#include "btf/direction.h"
#include "fixture.h"
#include "study/compare.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 5, HEIGHT = 4 };

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

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The error of `flat` against `glossy` straight from the two functions. */
static weft_prediction_error expected_error(int ring)
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
    qsort(relative, (size_t)count, sizeof *relative, ascending);
    double median = 0.5 * (relative[count / 2] + relative[(count - 1) / 2]);
    return (weft_prediction_error){count, sqrt(errors / squares), median};
}

static char *read_page(const char *path)
{
    char *text;
    size_t size;
    weft_error error = {0};
    expect_ok(weft_read_file(path, 1 << 24, &text, &size, &error), &error);
    return text;
}

static void expect_error(const weft_prediction_error *measured, const weft_prediction_error *expected)
{
    assert_int_equal(measured->count, expected->count);
    assert_float_equal(measured->relative_rmse, expected->relative_rmse, 2e-3 * expected->relative_rmse);
    assert_float_equal(measured->median_relative, expected->median_relative, 5e-3 * expected->median_relative);
}

static void the_page_tells_the_errors_that_the_functions_have(void **state)
{
    (void)state;
    fixture_far_dataset("compare.btf.h5", WIDTH, HEIGHT, 3, glossy, 1);
    fixture_diffuse_material("compare.weft", WIDTH, HEIGHT, flat);
    const weft_compare_options options = {
        .dataset = "compare.btf.h5", .material = "compare.weft", .folder = "compare-report"};
    weft_comparison comparison;
    weft_error error = {0};
    expect_ok(weft_compare(&options, NULL, &comparison, &error), &error);
    weft_prediction_error all = expected_error(-1), ring = expected_error(2);
    expect_error(&comparison.measurement.all, &all);
    expect_error(&comparison.measurement.by_view[2], &ring);
    assert_int_equal(comparison.measurement.by_view[4].count, 0);
    assert_int_equal(comparison.measurement.saturated, 1);
    assert_int_equal(comparison.left_out.count, 0);
    char *page = read_page("compare-report/index.html"), row[128];
    const weft_prediction_error *m = &comparison.measurement.all;
    snprintf(row, sizeof row, "<td>all</td><td>%ld</td><td>%.2f %%</td><td>%.4f</td>", m->count,
             100 * m->median_relative, m->relative_rmse);
    assert_non_null(strstr(page, row));
    assert_int_equal(access("compare-report/texels-2-difference.png", R_OK), 0);
    assert_true((strstr(page, "There are no pictures of scenes") != NULL) == !comparison.scenes.drawn);
    free(page);
    weft_comparison_free(&comparison);
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

static void a_matt_plane_is_predicted_from_the_other_photographs(void **state)
{
    (void)state;
    fixture_near_dataset("compare.btf.h5", 4, 6, matt);
    fixture_diffuse_material("compare.weft", 4, 4, black);
    const weft_compare_options options = {
        .dataset = "compare.btf.h5", .material = "compare.weft", .folder = "compare-report"};
    weft_comparison comparison;
    weft_error error = {0};
    expect_ok(weft_compare(&options, NULL, &comparison, &error), &error);
    assert_int_equal(comparison.left_out.count, 6);
    assert_true(comparison.left_out.mean_relative_rmse < 0.05);
    assert_true(comparison.left_out.mean_median_relative < 0.05);
    assert_float_equal(comparison.measurement.all.relative_rmse, 1, 1e-6);
    double mean = 0;
    for (int i = 0; i < 6; i++)
        mean += comparison.left_out.photograph[i].error.relative_rmse / 6;
    assert_float_equal(comparison.left_out.mean_relative_rmse, mean, 1e-12);
    weft_comparison_free(&comparison);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_page_tells_the_errors_that_the_functions_have),
        cmocka_unit_test(a_matt_plane_is_predicted_from_the_other_photographs),
        cmocka_unit_test(a_material_of_another_size_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
