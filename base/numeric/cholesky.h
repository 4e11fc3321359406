/* Cholesky's factorisation A = L L' of small dense symmetric matrices. All functions are pure and thread-safe. */
#ifndef WEFT_BASE_NUMERIC_CHOLESKY_H
#define WEFT_BASE_NUMERIC_CHOLESKY_H

#include <stdbool.h>

/* Replaces the lower triangle of `a`, n rows of n numbers that start `stride` numbers apart, by L. The part above the
 * diagonal is neither read nor written. False where A is not positive definite to within rounding (a pivot is at most
 * 1e-14 of its diagonal element) or not finite; `a` then holds nothing of use. */
bool weft_cholesky_factor(int n, int stride, double *a);

/* Replaces x [n] by the solution y of L y = x, for the L that weft_cholesky_factor left in `l`. The squared length of y
 * is x' A^-1 x. */
void weft_cholesky_solve_lower(int n, int stride, const double *l, double *x);

/* Replaces x [n] by the solution y of A y = x, for the L that weft_cholesky_factor left in `l`. */
void weft_cholesky_solve(int n, int stride, const double *l, double *x);

#endif
