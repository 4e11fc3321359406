/* Weighted linear least squares with a few unknowns, by normal equations and Cholesky's factorisation. */
#ifndef WEFT_REGISTRATION_POSE_NORMAL_EQUATIONS_H
#define WEFT_REGISTRATION_POSE_NORMAL_EQUATIONS_H

#include <stdbool.h>

enum { WEFT_UNKNOWNS_LIMIT = 20 };

typedef struct weft_normal_equations {
    double matrix[WEFT_UNKNOWNS_LIMIT][WEFT_UNKNOWNS_LIMIT]; /* sum of w a a^T; the lower triangle is used */
    double right[WEFT_UNKNOWNS_LIMIT];                       /* sum of w a y */
    double squares, weights;                                 /* sums of w y^2 and of w */
} weft_normal_equations;

/* Adds the equation row . x = value with the given weight; entries of `row` beyond the unknowns are zero. Pure. */
static inline void weft_normal_equations_add(weft_normal_equations *equations, const double row[WEFT_UNKNOWNS_LIMIT],
                                             double value, double weight)
{
    for (int i = 0; i < WEFT_UNKNOWNS_LIMIT; i++) {
        double scaled = weight * row[i];
        for (int j = 0; j < WEFT_UNKNOWNS_LIMIT; j++)
            equations->matrix[i][j] += scaled * row[j];
        equations->right[i] += scaled * value;
    }
    equations->squares += weight * value * value;
    equations->weights += weight;
}

void weft_normal_equations_merge(weft_normal_equations *sum, const weft_normal_equations *part);

/* Replaces the lower triangle by its Cholesky factor. False where the matrix of the first `count` unknowns is singular.
 */
bool weft_normal_equations_factor(weft_normal_equations *equations, int count);

/* After factoring: the solution, and the variance row^T matrix^-1 row of a linear form of it (for unit noise). */
void weft_normal_equations_solve(const weft_normal_equations *factored, int count, double *solution);
double weft_normal_equations_variance(const weft_normal_equations *factored, int count, const double *row);

/* After factoring `count` unknowns: what the equations say of the last `kept` of them, all others eliminated (Schur's
 * complement). information [kept][kept], gradient [kept]: information . x = gradient. */
void weft_normal_equations_reduce(const weft_normal_equations *factored, int count, int kept, double *information,
                                  double *gradient);

#endif
