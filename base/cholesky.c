#include "base/cholesky.h"

#include <math.h>
#include <stddef.h>

static const double least_pivot = 1e-14; /* of the diagonal element: a smaller one is rounding error */

bool weft_cholesky_factor(int n, int stride, double *a)
{
    for (int i = 0; i < n; i++) {
        double *row = a + (ptrdiff_t)i * stride;
        for (int j = 0; j < i; j++) {
            const double *other = a + (ptrdiff_t)j * stride;
            double sum = row[j];
            for (int k = 0; k < j; k++)
                sum -= row[k] * other[k];
            row[j] = sum / other[j];
        }
        double pivot = row[i];
        for (int k = 0; k < i; k++)
            pivot -= row[k] * row[k];
        if (!(pivot > least_pivot * row[i]))
            return false;
        row[i] = sqrt(pivot);
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
