/* Levenberg-Marquardt of MINPACK (More, Garbow and Hillstrom 1980; cminpack) with analytic derivatives, as a yardstick.
 * It knows no bounds: rho, A and ln N are squares of its variables (Box 1966), so that it stays within what a material
 * can store, but for an upper end of N. Both return 0, or -1 where MINPACK gave up or memory was short. */
#ifndef WEFT_BENCH_FIT_MINPACK_H
#define WEFT_BENCH_FIT_MINPACK_H

#include "bench/fit/problem.h"

/* The alternation of Daubert et al. 2001: lobes by lmder with T fixed, T by eq. 4, until the mean change of T is below
 * `threshold` or `max_rounds`. */
int minpack_alternate(problem *given, double threshold, int max_rounds, solution *result);

/* Lobes and T together: T eliminated by hand from the residual and, after Kaufman 1975, from the derivatives. With T as
 * 81 more unknowns its dense QR would be a hundred times dearer. */
int minpack_joint(problem *given, solution *result);

#endif
