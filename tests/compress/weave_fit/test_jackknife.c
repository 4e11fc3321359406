/* The variances of fitted parameters, against fits from which one cluster after another is left out. */
#include "compress/weave_fit/least_squares.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdint.h>

enum { ROWS = 60, COLUMNS = 3, CLUSTERS = 12 };

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0 - 0.5;
}

/* Solves the normal equations of all rows but those of `left_out`, by elimination. */
static void fit(const double a[ROWS][COLUMNS], const double *b, const int *cluster, int left_out, double x[COLUMNS])
{
    double m[COLUMNS][COLUMNS + 1] = {{0}};
    for (int row = 0; row < ROWS; row++)
        for (int i = 0; i < COLUMNS && cluster[row] != left_out; i++) {
            for (int j = 0; j < COLUMNS; j++)
                m[i][j] += a[row][i] * a[row][j];
            m[i][COLUMNS] += a[row][i] * b[row];
        }
    for (int i = 0; i < COLUMNS; i++)
        for (int other = 0; other < COLUMNS; other++) {
            double share = other == i ? 0 : m[other][i] / m[i][i];
            for (int j = 0; j <= COLUMNS && other != i; j++)
                m[other][j] -= share * m[i][j];
        }
    for (int i = 0; i < COLUMNS; i++)
        x[i] = m[i][COLUMNS] / m[i][i];
}

/* A straight fit, whose changes to first order are the changes; residuals of a cluster have a part in common. */
static void make_fit(double a[ROWS][COLUMNS], double *b, int *cluster, double *residual)
{
    uint64_t seed = 3;
    double x[COLUMNS], common[CLUSTERS];
    for (int c = 0; c < CLUSTERS; c++)
        common[c] = uniform(&seed);
    for (int row = 0; row < ROWS; row++) {
        cluster[row] = row % CLUSTERS;
        for (int i = 0; i < COLUMNS; i++)
            a[row][i] = 10 * uniform(&seed) / (i + 1) + (i == 1 ? 0.5 * a[row][0] : 0);
        b[row] = 2 * a[row][0] - a[row][1] + common[cluster[row]] + 0.3 * uniform(&seed);
    }
    fit((const double(*)[COLUMNS])a, b, cluster, -1, x);
    for (int row = 0; row < ROWS; row++)
        residual[row] = a[row][0] * x[0] + a[row][1] * x[1] + a[row][2] * x[2] - b[row];
}

static void variances_are_those_of_fits_without_a_cluster(void **state)
{
    (void)state;
    double a[ROWS][COLUMNS], b[ROWS], residual[ROWS], all[COLUMNS], expected[COLUMNS] = {0}, found[COLUMNS];
    int cluster[ROWS];
    make_fit(a, b, cluster, residual);
    fit((const double(*)[COLUMNS])a, b, cluster, -1, all);
    for (int c = 0; c < CLUSTERS; c++) {
        double x[COLUMNS];
        fit((const double(*)[COLUMNS])a, b, cluster, c, x);
        for (int i = 0; i < COLUMNS; i++)
            expected[i] += (x[i] - all[i]) * (x[i] - all[i]) * (CLUSTERS - 1) / CLUSTERS;
    }
    weft_linearised solution = {ROWS, COLUMNS, residual, a[0]};
    assert_int_equal(weft_jackknife_variance(&solution, cluster, CLUSTERS, found, NULL), WEFT_OK);
    for (int i = 0; i < COLUMNS; i++)
        assert_float_equal(found[i] / expected[i], 1, 1e-4);
}

static void what_is_held_has_no_variance_and_what_is_undetermined_any(void **state)
{
    (void)state;
    double a[ROWS][COLUMNS], b[ROWS], residual[ROWS], wide[ROWS][5], found[5];
    int cluster[ROWS];
    make_fit(a, b, cluster, residual);
    for (int row = 0; row < ROWS; row++) {
        wide[row][0] = a[row][0];
        wide[row][1] = 0;
        wide[row][2] = a[row][1];
        wide[row][3] = 3 * a[row][1]; /* nothing tells it from the column before */
        wide[row][4] = a[row][2];
    }
    weft_linearised solution = {ROWS, 5, residual, wide[0]};
    assert_int_equal(weft_jackknife_variance(&solution, cluster, CLUSTERS, found, NULL), WEFT_OK);
    assert_true(isfinite(found[0]) && found[0] > 0 && isfinite(found[4]) && found[4] > 0);
    assert_float_equal(found[1], 0, 0);
    assert_true(isinf(found[2]) && isinf(found[3]));
}

static void one_cluster_tells_nothing(void **state)
{
    (void)state;
    double a[ROWS][COLUMNS], b[ROWS], residual[ROWS], found[COLUMNS];
    int cluster[ROWS];
    make_fit(a, b, cluster, residual);
    for (int row = 0; row < ROWS; row++)
        cluster[row] = 0;
    weft_linearised solution = {ROWS, COLUMNS, residual, a[0]};
    assert_int_equal(weft_jackknife_variance(&solution, cluster, 1, found, NULL), WEFT_OK);
    for (int i = 0; i < COLUMNS; i++)
        assert_true(isinf(found[i]));
}

int test_jackknife(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(variances_are_those_of_fits_without_a_cluster),
        cmocka_unit_test(what_is_held_has_no_variance_and_what_is_undetermined_any),
        cmocka_unit_test(one_cluster_tells_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
