/* Derivatives of residuals by differences. */
#include "compress/weave_fit/least_squares.h"

#include <math.h>
#include <string.h>

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
