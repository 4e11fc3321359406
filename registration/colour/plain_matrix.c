#include "registration/colour/patches.h"

#include "base/numeric/cholesky.h"

#include <math.h>

static double variance(const weft_chart_colours *colours, int channel)
{
    double sum = 0, squares = 0;
    for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
        sum += colours->rgb[i][channel];
        squares += colours->rgb[i][channel] * colours->rgb[i][channel];
    }
    return squares - sum * sum / WEFT_CHART_PATCHES;
}

/* The squares that are left of a channel of the reference: r'r - b'A^-1 b. */
static double unexplained(const double factor[9], const weft_chart_colours *light, const weft_chart_colours *reference,
                          int channel)
{
    double right[3] = {0, 0, 0}, squares = 0;
    for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
        squares += reference->rgb[i][channel] * reference->rgb[i][channel];
        for (int c = 0; c < 3; c++)
            right[c] += light->rgb[i][c] * reference->rgb[i][channel];
    }
    weft_cholesky_solve_lower(3, 3, factor, right);
    return squares - right[0] * right[0] - right[1] * right[1] - right[2] * right[2];
}

double weft_plain_matrix_agreement(const weft_chart_colours *light, const weft_chart_colours *reference)
{
    double matrix[9] = {0}, left = 0, whole = 0;
    for (int i = 0; i < WEFT_CHART_PATCHES; i++)
        for (int k = 0; k < 9; k++)
            matrix[k] += light->rgb[i][k / 3] * light->rgb[i][k % 3];
    if (!weft_cholesky_factor(3, 3, matrix))
        return 0;
    for (int c = 0; c < 3; c++) {
        left += unexplained(matrix, light, reference, c);
        whole += variance(reference, c);
    }
    return fmax(0, 1 - left / whole);
}
