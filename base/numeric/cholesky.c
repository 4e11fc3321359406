#include "base/numeric/cholesky.h"

#include <math.h>
#include <stddef.h>

static const double least_pivot = 1e-14; /* of the diagonal element: a smaller one is rounding error */

/* Column by column: the rows below a pivot do not wait for each other. */
bool weft_cholesky_factor(int n, int stride, double *a)
{
    for (int j = 0; j < n; j++) {
        double *pivot_row = a + (ptrdiff_t)j * stride, pivot = pivot_row[j];
        for (int k = 0; k < j; k++)
            pivot -= pivot_row[k] * pivot_row[k];
        if (!(pivot > least_pivot * pivot_row[j]))
            return false;
        pivot_row[j] = sqrt(pivot);
        for (int i = j + 1; i < n; i++) {
            double *row = a + (ptrdiff_t)i * stride, sum = row[j];
            for (int k = 0; k < j; k++)
                sum -= row[k] * pivot_row[k];
            row[j] = sum / pivot_row[j];
        }
    }
    return true;
}

void weft_cholesky_solve_lower(int n, int stride, const double *l, double *x)
{
    for (int i = 0; i < n; i++) {
        const double *row = l + (ptrdiff_t)i * stride;
        for (int k = 0; k < i; k++)
            x[i] -= row[k] * x[k];
        x[i] /= row[i];
    }
}

void weft_cholesky_solve(int n, int stride, const double *l, double *x)
{
    weft_cholesky_solve_lower(n, stride, l, x);
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++)
            x[i] -= l[(ptrdiff_t)k * stride + i] * x[k];
        x[i] /= l[(ptrdiff_t)i * stride + i];
    }
}
