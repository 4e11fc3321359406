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

void weft_normal_equations_reduce(const weft_normal_equations *factored, int count, int kept, double *information,
                                  double *gradient)
{
    /* With A = L L^T, the complement is M M^T with M the last rows and columns of L. */
    double forward[WEFT_UNKNOWNS_LIMIT];
    int first = count - kept;
    memcpy(forward, factored->right, (size_t)count * sizeof *forward);
    weft_cholesky_solve_lower(count, WEFT_UNKNOWNS_LIMIT, factored->matrix[0], forward);
    for (int i = 0; i < kept; i++) {
        const double *row = factored->matrix[first + i] + first;
        gradient[i] = 0;
        for (int k = 0; k <= i; k++)
            gradient[i] += row[k] * forward[first + k];
        for (int j = 0; j < kept; j++) {
            const double *other = factored->matrix[first + j] + first;
            information[i * kept + j] = 0;
            for (int k = 0; k <= (i < j ? i : j); k++)
                information[i * kept + j] += row[k] * other[k];
        }
    }
}
