#include "compress/fit/solve.h"

#include <math.h>

/* Cholesky of the leading m x m of `a` (row stride WEFT_SOLVE_MAX), then both substitutions in `x`. */
static bool cholesky_solve(int m, double a[WEFT_SOLVE_MAX][WEFT_SOLVE_MAX], double *x)
{
    for (int j = 0; j < m; j++) {
        double pivot = a[j][j];
        for (int k = 0; k < j; k++)
            pivot -= a[j][k] * a[j][k];
        if (!(pivot > 1e-14 * a[j][j]) || !isfinite(pivot))
            return false;
        a[j][j] = sqrt(pivot);
        for (int i = j + 1; i < m; i++) {
            double sum = a[i][j];
            for (int k = 0; k < j; k++)
                sum -= a[i][k] * a[j][k];
            a[i][j] = sum / a[j][j];
        }
    }
    for (int i = 0; i < m; i++) {
        for (int k = 0; k < i; k++)
            x[i] -= a[i][k] * x[k];
        x[i] /= a[i][i];
    }
    for (int i = m - 1; i >= 0; i--) {
        for (int k = i + 1; k < m; k++)
            x[i] -= a[k][i] * x[k];
        x[i] /= a[i][i];
    }
    return true;
}

/* Solves for the free variables with the others held at d. */
static bool solve_free(int n, const double *h, const double *g, const bool *fixed, double *d)
{
    double a[WEFT_SOLVE_MAX][WEFT_SOLVE_MAX], x[WEFT_SOLVE_MAX];
    int index[WEFT_SOLVE_MAX], m = 0;
    for (int i = 0; i < n; i++) {
        if (!fixed[i])
            index[m++] = i;
    }
    for (int i = 0; i < m; i++) {
        x[i] = g[index[i]];
        for (int j = 0; j < n; j++)
            x[i] -= fixed[j] ? h[index[i] * n + j] * d[j] : 0;
        for (int j = 0; j < m; j++)
            a[i][j] = h[index[i] * n + index[j]];
    }
    if (!cholesky_solve(m, a, x))
        return false;
    for (int i = 0; i < m; i++)
        d[index[i]] = x[i];
    return true;
}

bool weft_solve_box(int n, const double *h, const double *g, const double *low, const double *high, double *d)
{
    bool fixed[WEFT_SOLVE_MAX] = {false};
    for (int round = 0; round <= n; round++) {
        if (!solve_free(n, h, g, fixed, d))
            return false;
        bool inside = true;
        for (int i = 0; i < n; i++) {
            if (!fixed[i] && (d[i] < low[i] || d[i] > high[i])) {
                d[i] = d[i] < low[i] ? low[i] : high[i];
                fixed[i] = true;
                inside = false;
            }
        }
        if (inside)
            return true;
    }
    return true;
}
