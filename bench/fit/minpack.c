#include "bench/fit/minpack.h"

#include <cminpack.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct search {
    problem *given;
    solution *found;
    int eliminates_table;
} search;

/* Whether parameter p is the square of MINPACK's variable: all but cx, cy. */
static int is_square(int p)
{
    return p == 0 || (p - 1) % 4 == 0 || (p - 1) % 4 == 3;
}

static void read_variables(const double *variable, int n, double *x)
{
    for (int p = 0; p < n; p++)
        x[p] = is_square(p) ? variable[p] * variable[p] : variable[p];
}

static void write_residual(const search *with, double *residual)
{
    problem *given = with->given;
    given->code->evaluate(given, with->found->x, 0, given->sample_count);
    given->passes++;
    if (with->eliminates_table)
        problem_update_table(given, with->found->table);
    for (int view = 0; view < given->view_count; view++) {
        double t = with->found->table[view];
        for (int i = given->first[view]; i < given->first[view + 1]; i++)
            residual[i] = given->value[i] - t * given->model[i];
    }
}

/* -T df, or -T (df - f <f|df> / <f|f>) where T is eliminated. */
static void write_column(const search *with, const double *derivative, double factor, double *column)
{
    const problem *given = with->given;
    for (int view = 0; view < given->view_count; view++) {
        double along = 0, t = -with->found->table[view] * factor;
        if (with->eliminates_table) {
            double fd = 0, ff = 0;
            for (int i = given->first[view]; i < given->first[view + 1]; i++) {
                fd += given->model[i] * derivative[i];
                ff += given->model[i] * given->model[i];
            }
            along = ff > 0 ? fd / ff : 0;
        }
        for (int i = given->first[view]; i < given->first[view + 1]; i++)
            column[i] = t * (derivative[i] - along * given->model[i]);
    }
}

/* MINPACK wants derivatives only where it asked for the residual last, so that the powers are still there. */
static int evaluate(void *context, int m, int n, const double *variable, double *residual, double *jacobian, int stride,
                    int what)
{
    const search *with = context;
    read_variables(variable, n, with->found->x);
    if (what == 1) {
        write_residual(with, residual);
        return 0;
    }
    with->given->code->differentiate(with->given, with->found->x, 0, m);
    with->given->passes++;
    for (int p = 0; p < n; p++) {
        double factor = is_square(p) ? 2 * variable[p] : 1;
        write_column(with, with->given->column + (size_t)m * (size_t)p, factor, jacobian + (size_t)stride * (size_t)p);
    }
    return 0;
}

static int minimise(search *with)
{
    enum { MAX_EVALUATIONS = 100 };
    const double step_bound = 0.1; /* of all tried the one that ends soonest and lowest */
    int m = with->given->sample_count, n = with->given->parameter_count, pivot[PROBLEM_PARAMETERS], calls, jacobians;
    double variable[PROBLEM_PARAMETERS], scale[PROBLEM_PARAMETERS], qtf[PROBLEM_PARAMETERS];
    double work[3 * PROBLEM_PARAMETERS], *memory = malloc((size_t)m * (size_t)(n + 2) * sizeof *memory);
    if (!memory)
        return -1;
    for (int p = 0; p < n; p++)
        variable[p] = is_square(p) ? sqrt(fmax(with->found->x[p], 0)) : with->found->x[p];
    int outcome = lmder(evaluate, with, m, n, variable, memory, memory + 2 * (size_t)m, m, with->given->tolerance, 1e-9,
                        0, MAX_EVALUATIONS, scale, 1, step_bound, 0, &calls, &jacobians, pivot, qtf, work, work + n,
                        work + 2 * n, memory + m);
    read_variables(variable, n, with->found->x);
    free(memory);
    return outcome > 0 ? 0 : -1;
}

int minpack_alternate(problem *given, double threshold, int max_rounds, solution *result)
{
    search with = {given, result, 0};
    for (int round = 0; round < max_rounds; round++) {
        if (minimise(&with))
            return -1;
        if (!given->fits_table)
            return 0;
        given->code->evaluate(given, result->x, 0, given->sample_count);
        given->passes++;
        if (problem_update_table(given, result->table) < threshold)
            break;
    }
    return 0;
}

int minpack_joint(problem *given, solution *result)
{
    search with = {given, result, 1};
    if (minimise(&with))
        return -1;
    given->code->evaluate(given, result->x, 0, given->sample_count);
    given->passes++;
    problem_update_table(given, result->table);
    return 0;
}
