/* The one pass over the samples of a texel that a joint fit makes for every trial: per view, the products of the
 * columns from which residual, gradient, Gauss-Newton matrix and T all follow without another look at the samples.
 *
 * With b_i = l . M_i v, M_i = R^T diag(Cx, Cy, Cz)_i R, k = sqrt(w) S(l) l_z, h_i = k b_i^(N_i - 1), the columns of a
 * view are
 *     k | h_i l_x, h_i l_y, h_i l_z, q_i = h_i b_i log2 b_i for every lobe | e = r - T(v) k (rho + sum_i A_i b_i^N_i)
 * The lobe itself, k b_i^N_i, is M_i v times its first three columns, and so are its derivatives by any parameter of
 * M_i. */
#ifndef WEFT_COMPRESS_FIT_GRAM_H
#define WEFT_COMPRESS_FIT_GRAM_H

#include "compress/fit/bundle.h"

enum {
    WEFT_GRAM_LOBES = 3,
    WEFT_GRAM_COLUMNS = 2 + 4 * WEFT_GRAM_LOBES,
    WEFT_GRAM_PRODUCTS = WEFT_GRAM_COLUMNS * (WEFT_GRAM_COLUMNS + 1) / 2
};

/* Where the model is evaluated. */
typedef struct weft_gram_point {
    int lobe_count;
    float diffuse;
    float amplitude[WEFT_GRAM_LOBES];
    float exponent[WEFT_GRAM_LOBES];
    float shape[WEFT_GRAM_LOBES][3][3]; /* M_i, symmetric, |l . M v| <= 1 for unit l, v */
} weft_gram_point;

/* Number of columns, e the last. */
static inline int weft_gram_columns(int lobe_count)
{
    return 2 + 4 * lobe_count;
}

/* Place of the product of columns a <= b among all. */
static inline int weft_gram_product(int a, int b, int columns)
{
    return a * columns - a * (a - 1) / 2 + b - a;
}

#endif
