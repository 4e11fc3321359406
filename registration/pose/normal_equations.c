#include "registration/pose/normal_equations.h"

#include <math.h>

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
    double(*m)[WEFT_UNKNOWNS_LIMIT] = equations->matrix;
    for (int i = 0; i < count; i++) {
        double diagonal = m[i][i];
        for (int j = 0; j <= i; j++) {
            double sum = m[i][j];
            for (int k = 0; k < j; k++)
                sum -= m[i][k] * m[j][k];
            if (j < i)
                m[i][j] = sum / m[j][j];
            else if (sum > 1e-14 * diagonal && isfinite(sum))
                m[i][i] = sqrt(sum);
            else
                return false;
        }
    }
    return true;
}

static void solve_forward(const weft_normal_equations *factored, int count, const double *right, double *solution)
{
    for (int i = 0; i < count; i++) {
        double sum = right[i];
        for (int k = 0; k < i; k++)
            sum -= factored->matrix[i][k] * solution[k];
        solution[i] = sum / factored->matrix[i][i];
    }
}

void weft_normal_equations_solve(const weft_normal_equations *factored, int count, double *solution)
{
    solve_forward(factored, count, factored->right, solution);
    for (int i = count - 1; i >= 0; i--) {
        double sum = solution[i];
        for (int k = i + 1; k < count; k++)
            sum -= factored->matrix[k][i] * solution[k];
        solution[i] = sum / factored->matrix[i][i];
    }
}

double weft_normal_equations_variance(const weft_normal_equations *factored, int count, const double *row)
{
    double forward[WEFT_UNKNOWNS_LIMIT], sum = 0;
    solve_forward(factored, count, row, forward);
    for (int i = 0; i < count; i++)
        sum += forward[i] * forward[i];
    return sum;
}
