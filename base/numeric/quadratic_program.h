/* Small strictly convex quadratic programs whose only constraints are bounds. */
#ifndef WEFT_BASE_NUMERIC_QUADRATIC_PROGRAM_H
#define WEFT_BASE_NUMERIC_QUADRATIC_PROGRAM_H

#include <stdbool.h>

/* Most variables of a program. */
enum { WEFT_QUADRATIC_PROGRAM_MAX = 16 };

/* Finds the d [n] that minimises d'Hd / 2 - g'd over low <= d <= high, by a primal active-set method. `h` is [n][n],
 * row by row, symmetric; n is at most WEFT_QUADRATIC_PROGRAM_MAX. Bounds may be infinite, and equal bounds hold a
 * variable. `d` is written only; every element of a solution lies within its bounds exactly.
 *
 * False where there is no solution: H is not positive definite on the variables that are not held, a number is not
 * finite, a bound is not a number, a lower bound exceeds its upper bound, or the solution overflows. What h and g
 * say of held variables alone is not read. False, too, should rounding keep the search from settling, which no program
 * tried has done. `d` then holds nothing of use.
 *
 * Pure, thread-safe, without memory of its own. */
bool weft_quadratic_program_solve(int n, const double *h, const double *g, const double *low, const double *high,
                                  double *d);

#endif
