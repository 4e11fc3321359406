/* Small dense least-squares steps with bounds. */
#ifndef WEFT_COMPRESS_FIT_SOLVE_H
#define WEFT_COMPRESS_FIT_SOLVE_H

#include <stdbool.h>

enum { WEFT_SOLVE_MAX = 16 };

/* Minimises d'Hd / 2 - g'd over low <= d <= high by an active set: solve, fix what left its bounds, solve for the rest.
 * `h` is [n][n], symmetric, n <= WEFT_SOLVE_MAX. False where H is not positive definite on the free variables. Pure. */
bool weft_solve_box(int n, const double *h, const double *g, const double *low, const double *high, double *d);

#endif
