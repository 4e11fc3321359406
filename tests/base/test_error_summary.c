/* The measure of error against numbers worked out by hand. */
#include "tests/support/cmocka_all.h"

#include "base/numeric/error_summary.h"

#include <math.h>

static weft_error_summary summary_of(const weft_compared *value, size_t count)
{
    weft_error_summary result;
    assert_int_equal(weft_error_summary_of(value, count, &result, NULL), WEFT_OK);
    return result;
}

static weft_error_summary summary_of_group(const weft_compared *value, const uint8_t *group, size_t count, int chosen)
{
    weft_error_summary result;
    assert_int_equal(weft_error_summary_of_group(value, group, count, chosen, &result, NULL), WEFT_OK);
    return result;
}

/* Relative errors 0.1, 0.5 and 0, and a black sample. */
static const weft_compared values[] = {{1, 1.1f}, {4, 2}, {3, 3}, {0, 0.5f}};

static void both_rmse_are_over_all_values(void **state)
{
    (void)state;
    weft_error_summary all = summary_of(values, 4);
    assert_int_equal(all.count, 4);
    assert_float_equal(all.rmse, sqrt((0.01 + 4 + 0.25) / 4), 1e-6);
    assert_float_equal(all.relative_rmse, sqrt((0.01 + 4 + 0.25) / 26), 1e-6);
}

/* With the black one, whatever stands below the fraction, the median would be 0.5. */
static void dim_samples_have_no_relative_error(void **state)
{
    (void)state;
    const weft_compared dim[] = {{-1, 5}, {0, 5}, {0.9999e-4f, 5}, {1, 1.25f}},
                        bright[] = {{1.0001e-4f, 5}, {1, 1.25f}};
    assert_float_equal(summary_of(values, 4).median_relative, 0.1, 1e-6);
    assert_float_equal(summary_of(dim, 4).median_relative, 0.25, 0);
    assert_float_equal(summary_of(dim, 4).percentile80_relative, 0.25, 0);
    assert_true(summary_of(bright, 2).median_relative > 40000);
}

/* Brighter light changes no number but the RMSE. */
static void dim_is_relative_to_the_largest_sample(void **state)
{
    (void)state;
    const weft_compared dark[] = {{0x1p-15f, 5}, {1, 1.25f}, {2, 2.25f}};
    weft_compared brighter[3];
    for (int i = 0; i < 3; i++)
        brighter[i] = (weft_compared){1024 * dark[i].sample, 1024 * dark[i].prediction};
    weft_error_summary one = summary_of(dark, 3), other = summary_of(brighter, 3);
    assert_true(one.median_relative == other.median_relative);
    assert_true(one.percentile80_relative == other.percentile80_relative);
    assert_float_equal(one.relative_rmse, other.relative_rmse, 1e-12);
    assert_float_equal(one.psnr_db, other.psnr_db, 1e-9);
    assert_float_equal(1024 * one.rmse, other.rmse, 1e-9);
}

static void the_percentile_is_that_of_the_relative_errors(void **state)
{
    (void)state;
    weft_compared ten[10];
    for (int i = 0; i < 10; i++)
        ten[i] = (weft_compared){1, 1 + (float)((7 * i) % 10) / 16};
    assert_float_equal(summary_of(ten, 10).median_relative, 5.0 / 16, 0);
    assert_float_equal(summary_of(ten, 10).percentile80_relative, 7.0 / 16, 0);
}

/* One sample in a thousand is a highlight: the peak is not that one. */
static void the_peak_leaves_out_the_brightest_thousandth(void **state)
{
    (void)state;
    static weft_compared many[1001];
    for (int i = 0; i < 1001; i++)
        many[i] = (weft_compared){i == 500 ? 100 : 2, i == 500 ? 100 : 2.5f};
    weft_error_summary all = summary_of(many, 1001);
    assert_float_equal(all.psnr_db, 20 * log10(2 / all.rmse), 1e-9);
}

static void a_group_has_its_own_values_and_the_limit_of_all(void **state)
{
    (void)state;
    const weft_compared two[] = {{1e-5f, 2e-5f}, {1, 1.5f}, {0.5f, 0.5f}};
    const uint8_t group[] = {7, 3, 7};
    weft_error_summary seven = summary_of_group(two, group, 3, 7), none = summary_of_group(two, group, 3, 1);
    assert_int_equal(seven.count, 2);
    assert_true(seven.median_relative == 0 && seven.percentile80_relative == 0);
    assert_float_equal(summary_of_group(two, group, 3, 3).relative_rmse, 0.5, 1e-12);
    assert_int_equal(none.count, 0);
    assert_true(none.relative_rmse == 0 && none.rmse == 0 && none.median_relative == 0 && none.psnr_db == 0);
}

static void perfect_and_black_are_not_the_same(void **state)
{
    (void)state;
    const weft_compared perfect[] = {{1, 1}, {2, 2}}, black[] = {{0, 0}, {0, 1}};
    assert_true(summary_of(perfect, 2).psnr_db == INFINITY);
    assert_true(summary_of(perfect, 2).relative_rmse == 0);
    assert_true(summary_of(black, 2).psnr_db == 0);
    assert_true(summary_of(black, 2).relative_rmse == 0 && summary_of(black, 2).median_relative == 0);
}

static void sums_of_parts_are_those_of_the_whole(void **state)
{
    (void)state;
    weft_error_sums one = {0}, other = {0};
    weft_error_sums_add_value(&one, 3, 1);
    weft_error_sums_add_value(&other, 4, 4);
    weft_error_sums_add(&one, &other);
    assert_true(one.count == 2 && one.square == 25 && one.square_error == 4);
    assert_float_equal(weft_error_sums_relative_rmse(&one), 0.4, 1e-12);
}

int test_error_summary(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_rmse_are_over_all_values),
        cmocka_unit_test(dim_samples_have_no_relative_error),
        cmocka_unit_test(dim_is_relative_to_the_largest_sample),
        cmocka_unit_test(the_percentile_is_that_of_the_relative_errors),
        cmocka_unit_test(the_peak_leaves_out_the_brightest_thousandth),
        cmocka_unit_test(a_group_has_its_own_values_and_the_limit_of_all),
        cmocka_unit_test(perfect_and_black_are_not_the_same),
        cmocka_unit_test(sums_of_parts_are_those_of_the_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
