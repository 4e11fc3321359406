/* Non-negative least squares, by the sequential least-squares programming (Kraft 1994) of NLopt. */
#include "study/fit_weave/least_squares.h"

#include <math.h>
#include <nlopt.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_EVALUATIONS = 500 };

/* |A x - b|^2 / 2 up to a constant, its columns scaled to unit length. */
typedef struct quadratic {
    unsigned columns;
    double *h, *g, *length; /* A'A, A'b, |column| */
} quadratic;

static double evaluate(unsigned n, const double *x, double *gradient, void *context)
{
    const quadratic *of = context;
    double sum = 0;
    for (unsigned i = 0; i < n; i++) {
        double slope = -of->g[i];
        for (unsigned j = 0; j < n; j++)
            slope += of->h[i * n + j] * x[j];
        sum += x[i] * (slope - of->g[i]) / 2;
        if (gradient)
            gradient[i] = slope;
    }
    return sum;
}

static void accumulate(const quadratic *of, int rows, const double *a, const double *b)
{
    unsigned n = of->columns;
    for (int row = 0; row < rows; row++) {
        const double *own = a + (size_t)row * n;
        for (unsigned i = 0; i < n; i++) {
            of->g[i] += own[i] * b[row];
            for (unsigned j = 0; j < n; j++)
                of->h[i * n + j] += own[i] * own[j];
        }
    }
    for (unsigned i = 0; i < n; i++)
        of->length[i] = of->h[i * n + i] > 0 ? sqrt(of->h[i * n + i]) : 1;
    for (unsigned i = 0; i < n; i++) {
        of->g[i] /= of->length[i];
        for (unsigned j = 0; j < n; j++)
            of->h[i * n + j] /= of->length[i] * of->length[j];
    }
}

static weft_code minimise(quadratic *of, double *x, weft_error *error)
{
    double value;
    nlopt_opt solver = nlopt_create(NLOPT_LD_SLSQP, of->columns);
    if (!solver)
        return weft_fail_memory(error, "non-negative least squares", sizeof value);
    nlopt_set_min_objective(solver, evaluate, of);
    nlopt_set_lower_bounds1(solver, 0);
    nlopt_set_ftol_rel(solver, 1e-15);
    nlopt_set_xtol_rel(solver, 1e-12);
    nlopt_set_maxeval(solver, MOST_EVALUATIONS);
    /* Stopped by rounding is as close as it comes. */
    nlopt_result result = nlopt_optimize(solver, x, &value);
    nlopt_destroy(solver);
    if (result < 0 && result != NLOPT_ROUNDOFF_LIMITED)
        return weft_fail(error, WEFT_SYSTEM, "non-negative least squares: %s", nlopt_result_to_string(result));
    return WEFT_OK;
}

weft_code weft_non_negative_least_squares(int rows, int columns, const double *a, const double *b, double *x,
                                          weft_error *error)
{
    size_t n = (size_t)columns;
    double *memory = calloc(n * n + 2 * n, sizeof *memory);
    if (!memory)
        return weft_fail_memory(error, "non-negative least squares", (n * n + 2 * n) * sizeof *memory);
    quadratic of = {.columns = (unsigned)columns, .h = memory, .g = memory + n * n, .length = memory + n * n + n};
    accumulate(&of, rows, a, b);
    /* Not from an earlier solution, which may be as large as a column was small. */
    memset(x, 0, n * sizeof *x);
    weft_code code = minimise(&of, x, error);
    for (size_t i = 0; i < n; i++)
        x[i] = fmax(0, x[i] / of.length[i]);
    free(memory);
    return code;
}
