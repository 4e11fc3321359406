/* Repeats in autocorrelations that are written down. */
#include "tests/support/cmocka_all.h"

#include "base/numeric/repeat.h"

#include <math.h>

enum { COUNT = 120 };

/* Waves of a period within a slowly falling envelope. */
static void make_waves(double period, double *along)
{
    for (int lag = 0; lag < COUNT; lag++)
        along[lag] = exp(-lag / 400.0) * cos(6.283185307179586 * lag / period);
}

static void the_first_of_many_peaks_is_the_period(void **state)
{
    (void)state;
    double along[COUNT];
    make_waves(14.3, along);
    int lag = weft_repeat_first(along, COUNT);
    assert_int_equal(lag, 14);
    assert_float_equal(weft_repeat_vertex(along, lag), 14.3, 0.03);
}

/* Yarns of two colours: half the period fits less well. */
static void a_lower_peak_before_it_is_passed_over(void **state)
{
    (void)state;
    double along[COUNT], half[COUNT];
    make_waves(20, along);
    make_waves(10, half);
    for (int lag = 0; lag < COUNT; lag++)
        along[lag] = 0.3 * along[lag] + 0.7 * half[lag];
    assert_int_equal(weft_repeat_first(along, COUNT), 20);
}

static void nothing_repeats_without_two_of_it(void **state)
{
    (void)state;
    double along[COUNT];
    make_waves(90, along);
    assert_int_equal(weft_repeat_first(along, COUNT), 0);
    make_waves(60, along);
    assert_int_equal(weft_repeat_first(along, COUNT), 60);
}

static void weak_waves_are_noise(void **state)
{
    (void)state;
    double along[COUNT];
    make_waves(14.3, along);
    for (int lag = 1; lag < COUNT; lag++)
        along[lag] *= 0.19;
    assert_int_equal(weft_repeat_first(along, COUNT), 0);
    assert_int_equal(weft_repeat_first((const double[]){1}, 1), 0);
    assert_int_equal(weft_repeat_first((const double[]){1, 0}, 2), 0);
}

int test_repeat(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_of_many_peaks_is_the_period),
        cmocka_unit_test(a_lower_peak_before_it_is_passed_over),
        cmocka_unit_test(nothing_repeats_without_two_of_it),
        cmocka_unit_test(weak_waves_are_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
