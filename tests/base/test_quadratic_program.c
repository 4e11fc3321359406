#include "base/numeric/quadratic_program.h"
#include "tests/reflectance/random.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <string.h>

enum { MAX = WEFT_QUADRATIC_PROGRAM_MAX, ENUMERATED_MAX = 5 };

typedef struct program {
    int n;
    double h[MAX * MAX], g[MAX], low[MAX], high[MAX];
} program;

/* ---- Random programs ---- */

/* B'B, whose columns share a direction but for `difference`, with units up to 10^decades apart. */
static void make_matrix(program *p, double difference, double decades, uint64_t *random)
{
    double b[2 * MAX][MAX], unit[MAX];
    int rows = p->n + 1 + (int)random_between(random, 0, p->n);
    for (int i = 0; i < p->n; i++)
        unit[i] = pow(10, random_between(random, -decades / 2, decades / 2));
    for (int row = 0; row < rows; row++) {
        double shared = random_between(random, -1, 1);
        for (int i = 0; i < p->n; i++)
            b[row][i] = unit[i] * (shared + difference * random_between(random, -1, 1));
    }
    for (int i = 0; i < p->n; i++) {
        for (int j = 0; j < p->n; j++) {
            double sum = 0;
            for (int row = 0; row < rows; row++)
                sum += b[row][i] * b[row][j];
            p->h[i * p->n + j] = sum;
        }
    }
    for (int i = 0; i < p->n; i++)
        p->h[i * p->n + i] *= 1 + 1e-11; /* positive definite whatever `difference` */
}

/* One-sided, two-sided, none, or equal, in units of the variable; about zero or beside it. */
static void make_bounds(program *p, bool with_infinite, uint64_t *random)
{
    for (int i = 0; i < p->n; i++) {
        double unit = 1 / sqrt(p->h[i * p->n + i]), from = unit * random_between(random, -1, 1);
        int kind = (int)random_between(random, 0, 6);
        p->low[i] = kind == 0 ? 0 : from;
        p->high[i] = kind == 1 ? from : from + unit * random_between(random, 0, 2);
        if (kind == 0)
            p->high[i] = fabs(p->high[i]);
        if (with_infinite && (kind == 2 || kind == 3))
            p->high[i] = INFINITY;
        if (with_infinite && (kind == 3 || kind == 4))
            p->low[i] = -INFINITY;
    }
}

static program make_program(int n, double difference, double decades, bool with_infinite, uint64_t *random)
{
    program p = {.n = n};
    make_matrix(&p, difference, decades, random);
    make_bounds(&p, with_infinite, random);
    for (int i = 0; i < n; i++)
        p.g[i] = sqrt(p.h[i * n + i]) * random_between(random, -2, 2);
    return p;
}

/* ---- What a solution must be ---- */

static bool solve(const program *p, double *d)
{
    for (int i = 0; i < MAX; i++)
        d[i] = NAN; /* what was there before does not matter */
    return weft_quadratic_program_solve(p->n, p->h, p->g, p->low, p->high, d);
}

static double objective(const program *p, const double *d)
{
    long double sum = 0;
    for (int i = 0; i < p->n; i++) {
        sum -= (long double)p->g[i] * (long double)d[i];
        for (int j = 0; j < p->n; j++)
            sum += (long double)d[i] * (long double)p->h[i * p->n + j] * (long double)d[j] / 2;
    }
    return (double)sum;
}

/* The largest violation of the conditions of Karush, Kuhn and Tucker, as a part of the terms that cancel; INFINITY
 * outside the box. They make a point the minimum, as the objective is convex. */
static double violation(const program *p, const double *d)
{
    double worst = 0;
    for (int i = 0; i < p->n; i++) {
        if (!(d[i] >= p->low[i] && d[i] <= p->high[i]))
            return INFINITY;
        long double slope = (long double)p->g[i], size = fabsl(slope);
        for (int j = 0; j < p->n; j++) {
            slope -= (long double)p->h[i * p->n + j] * (long double)d[j];
            size += (long double)(sqrt(p->h[i * p->n + i] * p->h[j * p->n + j]) * fabs(d[j]));
        }
        bool may_rise = d[i]<p->high[i], may_fall = d[i]> p->low[i];
        if ((slope > 0 && may_rise) || (slope < 0 && may_fall))
            worst = fmax(worst, (double)(fabsl(slope) / size));
    }
    return worst;
}

static void check_many(int count, double difference, double decades, double tolerance)
{
    uint64_t random = 1;
    for (int i = 0; i < count; i++) {
        program p = make_program(1 + i % MAX, difference, decades, i / MAX % 2, &random);
        double d[MAX];
        if (!solve(&p, d))
            fail_msg("program %d of %d variables is not solved", i, p.n);
        if (violation(&p, d) > tolerance)
            fail_msg("program %d of %d variables: the conditions are missed by %g", i, p.n, violation(&p, d));
    }
}

/* ---- Every active set in turn ---- */

/* Gauss's elimination in long doubles, of m equations [m][m + 1]. False where they are singular. */
static bool eliminate(int m, long double a[ENUMERATED_MAX][ENUMERATED_MAX + 1])
{
    for (int k = 0; k < m; k++) {
        int best = k;
        for (int i = k; i < m; i++)
            best = fabsl(a[i][k]) > fabsl(a[best][k]) ? i : best;
        for (int j = 0; j <= m; j++) {
            long double kept = a[k][j];
            a[k][j] = a[best][j];
            a[best][j] = kept;
        }
        if (!(fabsl(a[k][k]) > 0))
            return false;
        for (int i = 0; i < m; i++) {
            long double factor = i == k ? 0 : a[i][k] / a[k][k];
            for (int j = k; j <= m; j++)
                a[i][j] -= factor * a[k][j];
        }
    }
    return true;
}

/* The stationary point with variables at their lower bound, at their upper bound, or free, by the digits of `set` to
 * the base of three. False where it lies outside the box. */
static bool stationary_point(const program *p, int set, double *d)
{
    long double a[ENUMERATED_MAX][ENUMERATED_MAX + 1];
    int index[ENUMERATED_MAX], m = 0;
    for (int i = 0; i < p->n; i++, set /= 3) {
        if (set % 3 == 2)
            index[m++] = i;
        d[i] = set % 3 == 2 ? 0 : set % 3 ? p->high[i] : p->low[i];
        if (!isfinite(d[i]))
            return false;
    }
    for (int i = 0; i < m; i++) {
        a[i][m] = (long double)p->g[index[i]];
        for (int j = 0; j < p->n; j++)
            a[i][m] -= (long double)p->h[index[i] * p->n + j] * (long double)d[j];
        for (int j = 0; j < m; j++)
            a[i][j] = (long double)p->h[index[i] * p->n + index[j]];
    }
    if (!eliminate(m, a))
        return false;
    bool inside = true;
    for (int i = 0; i < m; i++) {
        d[index[i]] = (double)(a[i][m] / a[i][i]);
        inside = inside && d[index[i]] >= p->low[index[i]] && d[index[i]] <= p->high[index[i]];
    }
    return inside;
}

static double least_of_all_sets(const program *p, double *best)
{
    int sets = 1;
    double least = INFINITY, d[MAX] = {0};
    for (int i = 0; i < p->n; i++)
        sets *= 3;
    for (int set = 0; set < sets; set++) {
        if (stationary_point(p, set, d) && objective(p, d) < least) {
            least = objective(p, d);
            memcpy(best, d, sizeof d);
        }
    }
    return least;
}

/* ---- Tests ---- */

static void a_bound_that_was_reached_first_is_let_go_again(void **state)
{
    (void)state;
    const program p = {2, {1, 0.9, 0.9, 1}, {-0.52, 1.64}, {0, 0}, {10, 10}};
    double d[MAX];
    assert_true(solve(&p, d));
    assert_true(d[0] == 0 && fabs(d[1] - 1.64) < 1e-15);
    assert_true(fabs(objective(&p, d) + 1.3448) < 1e-14);
}

static void a_minimum_inside_the_box_is_the_free_one(void **state)
{
    (void)state;
    const program p = {2, {2, 1, 1, 3}, {4, 7}, {0, -INFINITY}, {INFINITY, 3}};
    double d[MAX];
    assert_true(solve(&p, d));
    assert_true(fabs(d[0] - 1) < 1e-15 && fabs(d[1] - 2) < 1e-15);
}

static void no_active_set_does_better(void **state)
{
    (void)state;
    uint64_t random = 7;
    int at_bound = 0;
    for (int i = 0; i < 4000; i++) {
        program p = make_program(1 + i % ENUMERATED_MAX, i % 2 ? 1 : 0.1, i % 3 ? 0 : 4, i % 7 < 3, &random);
        double d[MAX], best[MAX] = {0};
        assert_true(solve(&p, d));
        double least = least_of_all_sets(&p, best);
        assert_true(objective(&p, d) <= least + 1e-10 * fabs(least));
        for (int k = 0; k < p.n; k++) {
            assert_true(fabs(d[k] - best[k]) <= 1e-8 * (fabs(best[k]) + 1 / sqrt(p.h[k * p.n + k])));
            at_bound += d[k] == p.low[k] || d[k] == p.high[k];
        }
    }
    assert_true(at_bound > 4000); /* of 12000: the programs are not trivial */
}

static void well_conditioned_programs_meet_the_conditions(void **state)
{
    (void)state;
    check_many(20000, 1, 0, 1e-13);
}

static void badly_scaled_programs_meet_the_conditions(void **state)
{
    (void)state;
    check_many(20000, 0.3, 12, 1e-13);
}

static void ill_conditioned_programs_meet_the_conditions(void **state)
{
    (void)state;
    check_many(20000, 1e-3, 0, 1e-13);
    check_many(20000, 1e-5, 4, 1e-13);
}

/* The free minimum has elements on their bounds: there the multipliers are nothing but rounding. */
static void multipliers_of_zero_do_not_keep_the_search_going(void **state)
{
    (void)state;
    uint64_t random = 11;
    for (int i = 0; i < 20000; i++) {
        program p = make_program(1 + i % MAX, i % 2 ? 1 : 1e-4, 4, false, &random);
        double minimum[MAX], d[MAX];
        for (int k = 0; k < p.n; k++)
            minimum[k] = random_bits(&random) & 1 ? p.low[k] : p.high[k];
        for (int k = 0; k < p.n; k++) {
            p.g[k] = 0;
            for (int j = 0; j < p.n; j++)
                p.g[k] += p.h[k * p.n + j] * minimum[j];
        }
        assert_true(solve(&p, d));
        assert_true(violation(&p, d) < 1e-13);
    }
}

static void equal_bounds_hold_a_variable_even_where_the_matrix_is_singular(void **state)
{
    (void)state;
    /* The first and the last column are the same. */
    program p = {3, {2, 1, 2, 1, 3, 1, 2, 1, 2}, {1, 1, 1}, {-INFINITY, -INFINITY, 0.25}, {INFINITY, INFINITY, 0.25}};
    double d[MAX];
    assert_true(solve(&p, d));
    assert_true(d[2] == 0.25 && violation(&p, d) < 1e-15);
    p.high[2] = 1;
    assert_false(solve(&p, d));
    for (int i = 0; i < 3; i++)
        p.low[i] = p.high[i] = i;
    assert_true(solve(&p, d));
    assert_true(d[0] == 0 && d[1] == 1 && d[2] == 2);
}

static void matrices_that_are_not_positive_definite_are_refused(void **state)
{
    (void)state;
    const program zero = {1, {0}, {1}, {-1}, {1}}, indefinite = {2, {1, 2, 2, 1}, {0, 0}, {-1, -1}, {1, 1}};
    double d[MAX];
    assert_false(solve(&zero, d));
    assert_false(solve(&indefinite, d));
}

static void numbers_without_a_minimum_are_refused(void **state)
{
    (void)state;
    const program good = {2, {2, 1, 1, 3}, {1, 1}, {0, 0.5}, {1, 0.5}}; /* the second is held */
    const double bad[3] = {NAN, INFINITY, -INFINITY};
    double d[MAX];
    assert_true(solve(&good, d));
    for (int which = 0; which < 3; which++) {
        for (int at = 0; at < 2; at++) {
            program p = good;
            p.h[at] = p.h[2 * at] = bad[which]; /* the matrix stays symmetric */
            assert_false(solve(&p, d));
        }
        program p = good;
        p.g[0] = bad[which];
        assert_false(solve(&p, d));
        p = good;
        p.h[3] = p.g[1] = bad[which]; /* of the held variable alone: not read */
        assert_true(solve(&p, d));
    }
    for (int at = 0; at < 2; at++) {
        program p = good;
        p.low[at] = NAN;
        assert_false(solve(&p, d));
        p = good;
        p.high[at] = NAN;
        assert_false(solve(&p, d));
        p = good;
        p.low[at] = p.high[at] + 1;
        assert_false(solve(&p, d));
    }
    program never = good, overflows = {1, {1e-300}, {1e300}, {-INFINITY}, {INFINITY}};
    never.low[0] = never.high[0] = INFINITY;
    assert_false(solve(&never, d));
    assert_false(solve(&overflows, d));
}

/* A matrix with eigenvalues down to rounding: the worst that callers may give. The search ends, and at a point that is
 * no worse than the corner of the box nearest to zero. */
static void nearly_singular_programs_end_within_the_box(void **state)
{
    (void)state;
    uint64_t random = 3;
    for (int i = 0; i < 20000; i++) {
        program p = make_program(1 + i % MAX, 1e-9, 4, false, &random);
        double d[MAX], corner[MAX];
        assert_true(solve(&p, d));
        for (int k = 0; k < p.n; k++) {
            assert_true(d[k] >= p.low[k] && d[k] <= p.high[k]);
            corner[k] = fabs(p.low[k]) < fabs(p.high[k]) ? p.low[k] : p.high[k];
        }
        assert_true(objective(&p, d) <= objective(&p, corner) + 1e-12 * fabs(objective(&p, corner)));
    }
}

static void the_same_program_has_the_same_solution_in_every_bit(void **state)
{
    (void)state;
    uint64_t random = 5;
    for (int i = 0; i < 100; i++) {
        program p = make_program(MAX, 0.01, 4, true, &random);
        double first[MAX], second[MAX];
        assert_true(solve(&p, first) && solve(&p, second));
        assert_memory_equal(first, second, sizeof first);
    }
}

int test_quadratic_program(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bound_that_was_reached_first_is_let_go_again),
        cmocka_unit_test(a_minimum_inside_the_box_is_the_free_one),
        cmocka_unit_test(no_active_set_does_better),
        cmocka_unit_test(well_conditioned_programs_meet_the_conditions),
        cmocka_unit_test(badly_scaled_programs_meet_the_conditions),
        cmocka_unit_test(ill_conditioned_programs_meet_the_conditions),
        cmocka_unit_test(multipliers_of_zero_do_not_keep_the_search_going),
        cmocka_unit_test(equal_bounds_hold_a_variable_even_where_the_matrix_is_singular),
        cmocka_unit_test(matrices_that_are_not_positive_definite_are_refused),
        cmocka_unit_test(numbers_without_a_minimum_are_refused),
        cmocka_unit_test(nearly_singular_programs_end_within_the_box),
        cmocka_unit_test(the_same_program_has_the_same_solution_in_every_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
