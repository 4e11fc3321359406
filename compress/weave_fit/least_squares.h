/* Small least-squares problems with bounds: non-linear ones by Ceres Solver (trust region, Levenberg-Marquardt), linear
 * ones by base/numeric/quadratic_program.h. Ceres stops early where a linear solution lies on a bound. */
#ifndef WEFT_COMPRESS_WEAVE_FIT_LEAST_SQUARES_H
#define WEFT_COMPRESS_WEAVE_FIT_LEAST_SQUARES_H

#include "base/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* residuals [residual_count] at parameters [parameter_count]; all finite. Called from one thread. */
typedef void weft_residual_function(void *context, const double *parameters, double *residuals);

typedef struct weft_least_squares {
    int parameter_count, residual_count;
    const double *low, *high; /* [parameter_count]; equal: the parameter is held there */
    const double *least_step; /* [parameter_count] of a difference; NULL: none */
    weft_residual_function *residuals;
    void *context;
} weft_least_squares;

/* Minimises the sum of squares between the bounds from `parameters`, both start and result, with derivatives by
 * differences over 0.3 % of a parameter, at least least_step. Errors: WEFT_SYSTEM where the solver fails. */
weft_code weft_least_squares_solve(const weft_least_squares *problem, double *parameters, weft_error *error);

/* The same differences: residuals [residual_count] at `parameters`, and their derivatives [residual_count]
 * [parameter_count], 0 for what is held. `scratch` [parameter_count + residual_count]. */
void weft_least_squares_linearise(const weft_least_squares *problem, const double *parameters, double *residuals,
                                  double *jacobian, double *scratch);

/* x >= 0 [columns] that minimises |A x - b|^2, A [rows][columns], at most WEFT_QUADRATIC_PROGRAM_MAX columns. The x of
 * a zero column is 0. Pure. Errors: WEFT_SYSTEM where a number is not finite or overflows. */
weft_code weft_non_negative_least_squares(int rows, int columns, const double *a, const double *b, double *x,
                                          weft_error *error);

/* ---- Standard errors, of residuals that are not independent ---- */

/* A solution of non-linear least squares: residuals r [rows] and their derivatives J [rows][columns]. Columns of
 * zeros are parameters that were held. */
typedef struct weft_linearised {
    int rows, columns;
    const double *residuals, *jacobian;
} weft_linearised;

/* Variances of the parameters where residuals of one cluster are correlated in any way and those of different
 * clusters are not: the sum over clusters c of the squared change of the parameters when c is left out, to first
 * order -(J'J - J_c'J_c)^-1 J_c'r_c, times (n - 1) / n (Bell and McCaffrey 2002, the estimate with the least optimism
 * for few clusters). cluster [rows] is the cluster of each residual, 0 to cluster_count - 1. variance [columns]: 0 for
 * what is held, INFINITY for what the residuals do not determine. Errors: WEFT_SYSTEM for memory. */
weft_code weft_jackknife_variance(const weft_linearised *solution, const int *cluster, int cluster_count,
                                  double *variance, weft_error *error);

#ifdef __cplusplus
}
#endif

#endif
