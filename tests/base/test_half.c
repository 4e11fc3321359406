#include "base/half.h"
#include "base/processor.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdbool.h>

enum { INFINITE_HALF = 0x7c00, HALF_COUNT = 65536 };

static bool is_nan_half(unsigned half)
{
    return (half & 0x7fff) > INFINITE_HALF;
}

/* By the definition of binary16. */
static double value_of(unsigned half)
{
    int exponent = (int)(half >> 10 & 31), mantissa = (int)(half & 1023);
    double magnitude = exponent == 0 ? ldexp(mantissa, -24) : ldexp(1024 + mantissa, exponent - 25);
    return half & 0x8000 ? -magnitude : magnitude;
}

static void every_half_has_the_value_of_its_definition(void **state)
{
    (void)state;
    for (unsigned half = 0; half < HALF_COUNT; half++) {
        float value = weft_float_of_half((weft_half)half);
        if ((half & 0x7c00) == INFINITE_HALF)
            assert_true(is_nan_half(half) ? isnan(value) : isinf(value) && (value < 0) == (half > 0x7fff));
        else
            assert_true(value == value_of(half) && !signbit(value) == (half < 0x8000));
    }
}

static void every_half_survives_a_round_trip(void **state)
{
    (void)state;
    for (unsigned half = 0; half < HALF_COUNT; half++) {
        weft_half back = weft_half_of_float(weft_float_of_half((weft_half)half));
        assert_true(is_nan_half(half) ? is_nan_half(back) : back == half);
    }
}

/* Between each half and the next: the midpoint goes to the even one, its neighbours to the nearer one. */
static void conversion_rounds_to_nearest_even(void **state)
{
    (void)state;
    for (unsigned half = 0; half < INFINITE_HALF; half++) {
        double next = half + 1 == INFINITE_HALF ? 65536 : value_of(half + 1);
        float middle = (float)((value_of(half) + next) / 2);
        unsigned even = half % 2 == 0 ? half : half + 1;
        assert_int_equal(weft_half_of_float(middle), even);
        assert_int_equal(weft_half_of_float(nextafterf(middle, 0)), half);
        assert_int_equal(weft_half_of_float(nextafterf(middle, INFINITY)), half + 1);
        assert_int_equal(weft_half_of_float(-middle), even | 0x8000);
    }
}

static void extreme_floats_become_zero_infinity_or_nan(void **state)
{
    (void)state;
    assert_int_equal(weft_half_of_float(65504), 0x7bff);
    assert_int_equal(weft_half_of_float(1e30f), INFINITE_HALF);
    assert_int_equal(weft_half_of_float(-INFINITY), 0xfc00);
    assert_int_equal(weft_half_of_float(1e-40f), 0);
    assert_int_equal(weft_half_of_float(-1e-10f), 0x8000);
    assert_true(is_nan_half(weft_half_of_float(NAN)));
}

/* Conversions of floats that are no denormals themselves. */
static weft_half there_and_back[HALF_COUNT];
static float value[HALF_COUNT];

static void denormals_off_change_no_conversion(void **state)
{
    (void)state;
    unsigned before = weft_denormals_off();
    for (unsigned half = 0; half < HALF_COUNT; half++) {
        value[half] = weft_float_of_half((weft_half)half);
        there_and_back[half] = weft_half_of_float(value[half]);
    }
    weft_denormals_restore(before);
    for (unsigned half = 0; half < HALF_COUNT; half++) {
        assert_true(is_nan_half(half) ? isnan(value[half]) && is_nan_half(there_and_back[half])
                                      : value[half] == weft_float_of_half((weft_half)half));
        assert_true(is_nan_half(half) || there_and_back[half] == half);
    }
}

int test_half(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_half_has_the_value_of_its_definition),
        cmocka_unit_test(every_half_survives_a_round_trip),
        cmocka_unit_test(conversion_rounds_to_nearest_even),
        cmocka_unit_test(extreme_floats_become_zero_infinity_or_nan),
        cmocka_unit_test(denormals_off_change_no_conversion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
