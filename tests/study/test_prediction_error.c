#include "study/error/prediction_error.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static const weft_prediction values[] = {
    {1.1f, 1, 0, 1},
    {2, 4, 0, 2},
    {3, 3, 1, 1},
    {0.5f, 0, 1, 2},
};

static weft_prediction_error error_of(weft_prediction_choice choice)
{
    weft_prediction_error result;
    assert_int_equal(weft_prediction_error_of(values, 4, choice, &result, NULL), WEFT_OK);
    return result;
}

static void relative_rmse_is_over_the_mean_square_of_the_samples(void **state)
{
    (void)state;
    weft_prediction_error all = error_of((weft_prediction_choice){WEFT_CHOOSE_ALL, 0});
    assert_int_equal(all.count, 4);
    assert_float_equal(all.relative_rmse, sqrt((0.01 + 4 + 0.25) / 26), 1e-6);
    assert_float_equal(all.rmse, sqrt((0.01 + 4 + 0.25) / 4), 1e-6);
}

static void the_median_floors_small_samples(void **state)
{
    (void)state;
    /* 0.1, 0.5, 0 and 0.5 / (1e-4 x 4) = 1250: the middle two are 0.1 and 0.5. */
    weft_prediction_error all = error_of((weft_prediction_choice){WEFT_CHOOSE_ALL, 0});
    assert_float_equal(all.median_relative, 0.3, 1e-6);
    weft_prediction_error ring = error_of((weft_prediction_choice){WEFT_CHOOSE_VIEW_RING, 1});
    assert_float_equal(ring.median_relative, 625, 1e-2);
}

static void rings_choose_their_own_values(void **state)
{
    (void)state;
    weft_prediction_error view = error_of((weft_prediction_choice){WEFT_CHOOSE_VIEW_RING, 0});
    weft_prediction_error light = error_of((weft_prediction_choice){WEFT_CHOOSE_LIGHT_RING, 1});
    weft_prediction_error none = error_of((weft_prediction_choice){WEFT_CHOOSE_LIGHT_RING, 5});
    assert_float_equal(view.relative_rmse, sqrt(4.01 / 17), 1e-6);
    assert_float_equal(view.rmse, sqrt(4.01 / 2), 1e-6);
    assert_float_equal(light.relative_rmse, sqrt(0.01 / 10), 1e-6);
    assert_int_equal(none.count, 0);
    assert_true(none.relative_rmse == 0 && none.rmse == 0 && none.median_relative == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(relative_rmse_is_over_the_mean_square_of_the_samples),
        cmocka_unit_test(the_median_floors_small_samples),
        cmocka_unit_test(rings_choose_their_own_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
