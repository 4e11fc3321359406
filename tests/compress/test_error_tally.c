/* Percentiles by histogram against sorted values. */
#include "base/numeric/statistics.h"
#include "tests/support/cmocka_all.h"

#include "compress/fit/error_tally.h"

#include <math.h>
#include <stdlib.h>

enum { COUNT = 20000 };

static double pseudo_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

static void percentiles_agree_with_sorted_values(void **state)
{
    (void)state;
    static double relative[COUNT], sample[COUNT];
    weft_error_tally *tally, *other;
    weft_error_sums sums = {0};
    uint32_t seed = 1;
    assert_int_equal(weft_error_tally_create(&tally, NULL), WEFT_OK);
    assert_int_equal(weft_error_tally_create(&other, NULL), WEFT_OK);
    for (int i = 0; i < COUNT; i++) {
        float value = (float)(0.01 + pseudo_random(&seed));
        float prediction = value * (float)(1 + pow(pseudo_random(&seed), 3));
        weft_error_tally_add(i % 2 ? tally : other, value, prediction);
        relative[i] = (double)((prediction - value) / value);
        sample[i] = (double)value;
        weft_error_sums one = {1, sample[i] * sample[i], (double)(prediction - value) * (double)(prediction - value)};
        weft_error_sums_add(&sums, &one);
    }
    weft_error_tally_merge(tally, other);
    weft_error_summary error = weft_error_tally_summarise(tally, &sums);
    assert_float_equal(error.median_relative / weft_quantile(relative, COUNT, 0.5), 1, 0.02);
    assert_float_equal(error.percentile80_relative / weft_quantile(relative, COUNT, 0.8), 1, 0.02);
    assert_float_equal(error.psnr_db, 20 * log10(weft_quantile(sample, COUNT, 0.999) / error.rmse), 0.1);
    weft_error_tally_free(tally);
    weft_error_tally_free(other);
}

static void dark_and_negative_samples_do_not_count_as_relative_errors(void **state)
{
    (void)state;
    weft_error_tally *tally;
    weft_error_sums sums = {.count = 1, .square = 1, .square_error = 1};
    assert_int_equal(weft_error_tally_create(&tally, NULL), WEFT_OK);
    for (int i = 0; i < 100; i++) {
        weft_error_tally_add(tally, 1, 1.1f);
        weft_error_tally_add(tally, 1e-6f, 5);
        weft_error_tally_add(tally, -1, 5);
        weft_error_tally_add(tally, 0, 5);
    }
    weft_error_summary error = weft_error_tally_summarise(tally, &sums);
    assert_float_equal(error.percentile80_relative, 0.1, 0.006);
    weft_error_tally_free(tally);
}

static void nothing_gives_zeros(void **state)
{
    (void)state;
    weft_error_tally *tally;
    weft_error_sums sums = {0};
    assert_int_equal(weft_error_tally_create(&tally, NULL), WEFT_OK);
    weft_error_summary error = weft_error_tally_summarise(tally, &sums);
    assert_true(error.median_relative == 0 && error.rmse == 0 && error.psnr_db == 0);
    weft_error_tally_free(tally);
}

static void entries_keep_every_count(void **state)
{
    (void)state;
    weft_error_tally *tally, *copy;
    const weft_error_sums sums = {1000, 500, 5};
    uint32_t seed = 2;
    assert_int_equal(weft_error_tally_create(&tally, NULL), WEFT_OK);
    assert_int_equal(weft_error_tally_create(&copy, NULL), WEFT_OK);
    for (int i = 0; i < 1000; i++) {
        float value = (float)exp(20 * pseudo_random(&seed) - 15);
        weft_error_tally_add(tally, value, value * (float)pseudo_random(&seed));
    }
    size_t count = weft_error_tally_entries(tally, NULL);
    uint32_t(*entry)[2] = calloc(count, sizeof *entry);
    assert_int_equal(weft_error_tally_entries(tally, entry), count);
    assert_true(weft_error_tally_add_entries(copy, entry, count));
    weft_error_summary one = weft_error_tally_summarise(tally, &sums), two = weft_error_tally_summarise(copy, &sums);
    assert_memory_equal(&one, &two, sizeof one);
    entry[0][0] = UINT32_MAX;
    assert_false(weft_error_tally_add_entries(copy, entry, 1));
    free(entry);
    weft_error_tally_free(tally);
    weft_error_tally_free(copy);
}

int test_error_tally(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(percentiles_agree_with_sorted_values),
        cmocka_unit_test(entries_keep_every_count),
        cmocka_unit_test(dark_and_negative_samples_do_not_count_as_relative_errors),
        cmocka_unit_test(nothing_gives_zeros),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
