#include "base/numeric/cholesky.h"
#include "tests/reflectance/random.h"
#include "tests/support/cmocka_all.h"

#include <math.h>

enum { MAX = 18 };

/* B'B for random rows B, one more than columns; the upper triangle is left as it was. */
static void make_lower(int n, uint64_t *state, double a[MAX][MAX])
{
    double b[MAX + 1][MAX];
    for (int row = 0; row <= n; row++) {
        for (int i = 0; i < n; i++)
            b[row][i] = random_between(state, -1, 1);
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= i; j++) {
            a[i][j] = 0;
            for (int row = 0; row <= n; row++)
                a[i][j] += b[row][i] * b[row][j];
        }
    }
}

static void the_factor_times_its_transpose_is_the_matrix(void **state)
{
    (void)state;
    uint64_t random = 1;
    for (int n = 1; n <= MAX; n++) {
        double a[MAX][MAX], l[MAX][MAX];
        make_lower(n, &random, a);
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < MAX; j++)
                l[i][j] = j <= i ? a[i][j] : NAN; /* neither read */
        }
        assert_true(weft_cholesky_factor(n, MAX, l[0]));
        for (int i = 0; i < n; i++) {
            assert_true(l[i][i] > 0);
            for (int j = 0; j <= i; j++) {
                double sum = 0;
                for (int k = 0; k <= j; k++)
                    sum += l[i][k] * l[j][k];
                assert_true(fabs(sum - a[i][j]) < 1e-14 * n);
            }
            for (int j = i + 1; j < MAX; j++)
                assert_true(isnan(l[i][j])); /* nor written */
        }
    }
}

static void a_solution_solves_and_a_half_solution_has_the_variance_of_the_form(void **state)
{
    (void)state;
    uint64_t random = 2;
    for (int n = 1; n <= MAX; n++) {
        double a[MAX][MAX], l[MAX][MAX], right[MAX], x[MAX], half[MAX], form = 0, square = 0;
        make_lower(n, &random, a);
        for (int i = 0; i < n; i++) {
            a[i][i] += 1;
            x[i] = half[i] = right[i] = random_between(&random, -1, 1);
            for (int j = 0; j <= i; j++)
                l[i][j] = a[i][j];
        }
        assert_true(weft_cholesky_factor(n, MAX, l[0]));
        weft_cholesky_solve(n, MAX, l[0], x);
        weft_cholesky_solve_lower(n, MAX, l[0], half);
        for (int i = 0; i < n; i++) {
            double product = 0;
            for (int j = 0; j < n; j++)
                product += (j <= i ? a[i][j] : a[j][i]) * x[j];
            assert_true(fabs(product - right[i]) < 1e-13 * n);
            form += right[i] * x[i];
            square += half[i] * half[i];
        }
        assert_true(fabs(square - form) < 1e-13 * n);
    }
}

static void a_matrix_that_is_not_positive_definite_is_refused(void **state)
{
    (void)state;
    double zero[1] = {0}, negative[1] = {-1}, indefinite[4] = {1, 2, 2, 1}, singular[4] = {1, 2, 2, 4};
    double rounded[4] = {1, 1, 1, 1 + 1e-15}, regular[4] = {1, 1, 1, 1 + 1e-12};
    assert_false(weft_cholesky_factor(1, 1, zero));
    assert_false(weft_cholesky_factor(1, 1, negative));
    assert_false(weft_cholesky_factor(2, 2, indefinite));
    assert_false(weft_cholesky_factor(2, 2, singular));
    assert_false(weft_cholesky_factor(2, 2, rounded));
    assert_true(weft_cholesky_factor(2, 2, regular));
    assert_true(weft_cholesky_factor(0, 1, zero));
}

static void numbers_that_are_not_finite_are_refused(void **state)
{
    (void)state;
    const double bad[3] = {NAN, INFINITY, -INFINITY};
    for (int which = 0; which < 3; which++) {
        for (int at = 0; at < 3; at++) {
            double a[4] = {2, 0, 1, 2};
            a[at == 0 ? 0 : at + 1] = bad[which];
            assert_false(weft_cholesky_factor(2, 2, a));
        }
    }
}

int test_cholesky(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_factor_times_its_transpose_is_the_matrix),
        cmocka_unit_test(a_solution_solves_and_a_half_solution_has_the_variance_of_the_form),
        cmocka_unit_test(a_matrix_that_is_not_positive_definite_is_refused),
        cmocka_unit_test(numbers_that_are_not_finite_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
