/* Standard errors of least squares whose residuals are not independent. */
#ifndef WEFT_STUDY_FIT_WEAVE_JACKKNIFE_H
#define WEFT_STUDY_FIT_WEAVE_JACKKNIFE_H

#include "base/status.h"

#ifdef __cplusplus
extern "C" {
#endif

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
