/* The model for a handful of images: a diffuse term and one mirror-like lobe a texel. Exponent and normal of a texel
 * are those under which its whole neighbourhood fits best, out of a shared set of exponents and slopes; rho and the
 * amplitude of each channel are the texel's own, non-negative least squares of the *relative* error. How sharp a
 * highlight and how steep a slope may be is chosen by leaving out one image after another. */
#ifndef WEFT_COMPRESS_SPARSE_SPARSE_H
#define WEFT_COMPRESS_SPARSE_SPARSE_H

#include "compress/sparse/field.h"

#include <stdbool.h>

/* The freedom of the fit. */
typedef struct weft_sparse_setting {
    double largest_exponent; /* 0: diffuse only */
    /* A slope s must lower the neighbourhood's squared error by 1 + stiffness s^2; infinite: upright. */
    double stiffness;
} weft_sparse_setting;

/* One texel: rho + A max(0, l'.diag(-1, -1, 1).v')^N, the normal being (slope_x, slope_y, 1) normalised. */
typedef struct weft_sparse_texel {
    float slope_x, slope_y, exponent;
    float diffuse[3], amplitude[3];
} weft_sparse_texel;

/* Chooses the setting by cross-validation on the field, halved until it has at most 128 x 128 texels. With fewer than
 * four images, or `lobes` off, it is diffuse only. Errors: WEFT_SYSTEM for memory. */
weft_code weft_sparse_choose(const weft_sparse_field *field, bool lobes, weft_sparse_setting *setting,
                             weft_error *error);

/* Fits all texels: result [height][width]. Uses OpenMP; the number of threads leaves no trace. */
weft_code weft_sparse_fit(const weft_sparse_field *field, const weft_sparse_setting *setting, weft_sparse_texel *result,
                          weft_error *error);

/* Reflectance times cosine of channel k. Pure. */
float weft_sparse_value(const weft_sparse_texel *texel, const float light[3], const float view[3], int channel);

#endif
