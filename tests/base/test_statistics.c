/* The rank of a quantile, and values that are not numbers. */
#include "tests/support/cmocka_all.h"

#include "base/numeric/statistics.h"

#include <math.h>

/* The rank of a quantile, from 0. */
static int rank_of(int count, double share)
{
    double value[1000];
    float same[1000];
    for (int i = 0; i < count; i++)
        same[i] = (float)(value[i] = (7 * i) % count);
    int rank = (int)weft_quantile(value, (size_t)count, share);
    assert_true(weft_quantile_of_floats(same, (size_t)count, share) == (float)rank);
    return rank;
}

static void the_rank_is_the_nearest_and_a_half_goes_up(void **state)
{
    (void)state;
    assert_int_equal(rank_of(1, 0.8), 0);
    assert_int_equal(rank_of(5, 0), 0);
    assert_int_equal(rank_of(5, 0.5), 2);
    assert_int_equal(rank_of(4, 0.5), 2);
    assert_int_equal(rank_of(6, 0.8), 4);
    assert_int_equal(rank_of(10, 0.8), 7);
    assert_int_equal(rank_of(1000, 0.999), 998);
    assert_int_equal(rank_of(5, 1), 4);
}

static void a_quantile_may_be_asked_for_again(void **state)
{
    (void)state;
    double value[] = {5, 1, 4, 2, 3, 60};
    assert_true(weft_quantile(value, 6, 0.5) == 4);
    assert_true(weft_quantile(value, 6, 0) == 1);
    assert_true(weft_quantile(value, 6, 1) == 60);
    assert_true(weft_quantile(value, 6, 0.5) == 4);
}

static void nothing_has_the_quantile_0(void **state)
{
    (void)state;
    double value[] = {7};
    float same[] = {7};
    assert_true(weft_quantile(value, 0, 0.5) == 0);
    assert_true(weft_quantile_of_floats(same, 0, 0.5) == 0);
}

static void what_is_no_number_counts_as_the_largest(void **state)
{
    (void)state;
    double value[] = {NAN, 2, INFINITY, NAN, 1};
    float same[] = {2, NAN, 1, -1, NAN};
    assert_true(weft_quantile(value, 5, 0.5) == INFINITY);
    assert_true(isnan(weft_quantile(value, 5, 0.75)) && weft_quantile(value, 5, 0.25) == 2);
    assert_true(weft_quantile_of_floats(same, 5, 0.25) == 1);
    assert_true(isnan(weft_quantile_of_floats(same, 5, 1)));
}

int test_statistics(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_rank_is_the_nearest_and_a_half_goes_up),
        cmocka_unit_test(a_quantile_may_be_asked_for_again),
        cmocka_unit_test(nothing_has_the_quantile_0),
        cmocka_unit_test(what_is_no_number_counts_as_the_largest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
