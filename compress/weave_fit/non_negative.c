/* Non-negative least squares, by the normal equations of columns of unit length. */
#include "base/numeric/quadratic_program.h"
#include "compress/weave_fit/least_squares.h"

#include <math.h>

enum { COLUMNS_MAX = WEFT_QUADRATIC_PROGRAM_MAX };

static const double ridge = 1e-12; /* decides between columns that are alike, and holds those that are zero */

weft_code weft_non_negative_least_squares(int rows, int columns, const double *a, const double *b, double *x,
                                          weft_error *error)
{
    double h[COLUMNS_MAX * COLUMNS_MAX] = {0}, g[COLUMNS_MAX] = {0}, low[COLUMNS_MAX] = {0};
    double high[COLUMNS_MAX], length[COLUMNS_MAX];
    for (int i = 0; i < COLUMNS_MAX; i++)
        high[i] = INFINITY;
    for (int row = 0; row < rows; row++, a += columns) {
        for (int i = 0; i < columns; i++) {
            g[i] += a[i] * b[row];
            for (int j = 0; j < columns; j++)
                h[i * columns + j] += a[i] * a[j];
        }
    }
    for (int i = 0; i < columns; i++)
        length[i] = h[i * columns + i] > 0 ? sqrt(h[i * columns + i]) : 1;
    for (int i = 0; i < columns; i++) {
        g[i] /= length[i];
        for (int j = 0; j < columns; j++)
            h[i * columns + j] /= length[i] * length[j];
        h[i * columns + i] += ridge;
    }
    if (!weft_quadratic_program_solve(columns, h, g, low, high, x))
        return weft_fail(error, WEFT_SYSTEM, "non-negative least squares: the numbers are not finite");
    for (int i = 0; i < columns; i++)
        x[i] /= length[i];
    return WEFT_OK;
}
