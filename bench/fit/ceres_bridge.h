/* Ceres Solver as a yardstick: analytic derivatives, one thread, bounds as in problem.h, one residual block for every
 * view. Both return 0, or -1 where Ceres failed. */
#ifndef WEFT_BENCH_FIT_CERES_BRIDGE_H
#define WEFT_BENCH_FIT_CERES_BRIDGE_H

#include "bench/fit/problem.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The alternation of Daubert et al. 2001: lobes with T fixed by dense normal equations and Cholesky, T by eq. 4, until
 * the mean change of T is below `threshold` or `max_rounds`. */
int ceres_alternate(problem *given, double threshold, int max_rounds, solution *result);

/* Lobes and T together, T eliminated by Ceres (DENSE_SCHUR). */
int ceres_joint(problem *given, solution *result);

#ifdef __cplusplus
}
#endif

#endif
