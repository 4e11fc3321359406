#include "registration/pose/normal_equations.h"

#include "tests/registration/near.h"
#include "tests/support/cmocka_all.h"

/* y = 2 + 3 t over t = 0..9, with the point at t = 4 wrong by 100 and given `weight_of_wrong`. */
static weft_normal_equations line(double weight_of_wrong)
{
    weft_normal_equations equations = {0};
    for (int t = 0; t < 10; t++) {
        double row[WEFT_UNKNOWNS_LIMIT] = {1, t};
        weft_normal_equations_add(&equations, row, 2 + 3 * t + (t == 4 ? 100 : 0), t == 4 ? weight_of_wrong : 1);
    }
    return equations;
}

static void a_line_through_its_points_is_found(void **state)
{
    (void)state;
    weft_normal_equations equations = line(0);
    double solution[2];
    assert_true(weft_normal_equations_factor(&equations, 2));
    weft_normal_equations_solve(&equations, 2, solution);
    assert_near(solution[0], 2, 1e-12);
    assert_near(solution[1], 3, 1e-12);
}

static void the_variance_of_a_mean_is_one_over_the_count(void **state)
{
    (void)state;
    weft_normal_equations equations = {0};
    const double row[WEFT_UNKNOWNS_LIMIT] = {1};
    for (int i = 0; i < 50; i++)
        weft_normal_equations_add(&equations, row, i, 1);
    assert_true(weft_normal_equations_factor(&equations, 1));
    assert_near(weft_normal_equations_variance(&equations, 1, row), 1.0 / 50, 1e-12);
}

static void merged_parts_equal_the_whole(void **state)
{
    (void)state;
    weft_normal_equations whole = line(0.5), part = line(0.5), sum = {0};
    weft_normal_equations_merge(&sum, &part);
    weft_normal_equations_merge(&sum, &part);
    assert_near(sum.matrix[1][0], 2 * whole.matrix[1][0], 1e-12);
    assert_near(sum.right[1], 2 * whole.right[1], 1e-9);
    assert_near(sum.squares, 2 * whole.squares, 1e-9);
    assert_near(sum.weights, 2 * whole.weights, 1e-12);
}

static void equations_that_say_nothing_of_an_unknown_are_singular(void **state)
{
    (void)state;
    weft_normal_equations equations = line(1);
    assert_false(weft_normal_equations_factor(&equations, 3));
}

int test_normal_equations(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_through_its_points_is_found),
        cmocka_unit_test(the_variance_of_a_mean_is_one_over_the_count),
        cmocka_unit_test(merged_parts_equal_the_whole),
        cmocka_unit_test(equations_that_say_nothing_of_an_unknown_are_singular),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
