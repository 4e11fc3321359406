#include "registration/pose/normal_equations.h"

#include "base/numeric/cholesky.h"

#include <string.h>

void weft_normal_equations_merge(weft_normal_equations *sum, const weft_normal_equations *part)
{
    for (int i = 0; i < WEFT_UNKNOWNS_LIMIT; i++) {
        for (int j = 0; j < WEFT_UNKNOWNS_LIMIT; j++)
            sum->matrix[i][j] += part->matrix[i][j];
        sum->right[i] += part->right[i];
    }
    sum->squares += part->squares;
    sum->weights += part->weights;
}

bool weft_normal_equations_factor(weft_normal_equations *equations, int count)
{
    return weft_cholesky_factor(count, WEFT_UNKNOWNS_LIMIT, equations->matrix[0]);
}

void weft_normal_equations_solve(const weft_normal_equations *factored, int count, double *solution)
{
    memcpy(solution, factored->right, (size_t)count * sizeof *solution);
    weft_cholesky_solve(count, WEFT_UNKNOWNS_LIMIT, factored->matrix[0], solution);
}

double weft_normal_equations_variance(const weft_normal_equations *factored, int count, const double *row)
{
    double forward[WEFT_UNKNOWNS_LIMIT], sum = 0;
    memcpy(forward, row, (size_t)count * sizeof *forward);
    weft_cholesky_solve_lower(count, WEFT_UNKNOWNS_LIMIT, factored->matrix[0], forward);
    for (int i = 0; i < count; i++)
        sum += forward[i] * forward[i];
    return sum;
}
