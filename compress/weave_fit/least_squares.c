#include "compress/weave_fit/least_squares.h"

#include "base/numeric/quadratic_program.h"

#include <math.h>
#include <string.h>

/* ---- Differences ---- */

/* Derivatives of residuals by differences. */

/* Of a parameter, or of a hundredth of its range where it is smaller. Batches of woven reflectance are exact to about
 * 1e-5 (reflectance/weave/batch.h): differences have to stand out from that. */
static const double relative_step = 3e-3;

/* Forward, but backward where the upper bound is near. */
static double step_of(const weft_least_squares *problem, const double *parameters, int i)
{
    double range = problem->high[i] - problem->low[i];
    double step = relative_step * fmax(fabs(parameters[i]), 0.01 * range);
    if (problem->least_step)
        step = fmax(step, problem->least_step[i]);
    return parameters[i] + step > problem->high[i] ? -step : step;
}

static void differentiate(const weft_least_squares *problem, int i, double *moved, double *other,
                          const double *residuals, double *jacobian)
{
    double start = moved[i], step = step_of(problem, moved, i);
    moved[i] = start + step;
    problem->residuals(problem->context, moved, other);
    moved[i] = start;
    for (int row = 0; row < problem->residual_count; row++)
        jacobian[(size_t)row * (size_t)problem->parameter_count + (size_t)i] = (other[row] - residuals[row]) / step;
}

void weft_least_squares_linearise(const weft_least_squares *problem, const double *parameters, double *residuals,
                                  double *jacobian, double *scratch)
{
    size_t columns = (size_t)problem->parameter_count, rows = (size_t)problem->residual_count;
    double *moved = scratch;
    memcpy(moved, parameters, columns * sizeof *moved);
    memset(jacobian, 0, rows * columns * sizeof *jacobian);
    problem->residuals(problem->context, parameters, residuals);
    for (int i = 0; i < problem->parameter_count; i++)
        if (problem->low[i] < problem->high[i])
            differentiate(problem, i, moved, moved + columns, residuals, jacobian);
}

/* ---- Non negative ---- */

/* Non-negative least squares, by the normal equations of columns of unit length. */

enum { COLUMNS_MAX = WEFT_QUADRATIC_PROGRAM_MAX };

static const double ridge = 1e-12; /* decides between columns that are alike, and holds those that are zero */

weft_code weft_non_negative_least_squares(int rows, int columns, const double *a, const double *b, double *x,
                                          weft_error *error)
{
    double h[COLUMNS_MAX * COLUMNS_MAX] = {0}, g[COLUMNS_MAX] = {0}, low[COLUMNS_MAX] = {0};
    double high[COLUMNS_MAX], length[COLUMNS_MAX];
    for (int i = 0; i < COLUMNS_MAX; i++)
        high[i] = INFINITY;
    for (int row = 0; row < rows; row++, a += columns) {
        for (int i = 0; i < columns; i++) {
            g[i] += a[i] * b[row];
            for (int j = 0; j < columns; j++)
                h[i * columns + j] += a[i] * a[j];
        }
    }
    for (int i = 0; i < columns; i++)
        length[i] = h[i * columns + i] > 0 ? sqrt(h[i * columns + i]) : 1;
    for (int i = 0; i < columns; i++) {
        g[i] /= length[i];
        for (int j = 0; j < columns; j++)
            h[i * columns + j] /= length[i] * length[j];
        h[i * columns + i] += ridge;
    }
    if (!weft_quadratic_program_solve(columns, h, g, low, high, x))
        return weft_fail(error, WEFT_SYSTEM, "non-negative least squares: the numbers are not finite");
    for (int i = 0; i < columns; i++)
        x[i] /= length[i];
    return WEFT_OK;
}
