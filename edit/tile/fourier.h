/* The two-dimensional discrete Fourier transform, by OpenCV, which the registration needs already. */
#ifndef WEFT_EDIT_TILE_FOURIER_H
#define WEFT_EDIT_TILE_FOURIER_H

#include "base/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Transforms `values` [height][width][re, im] in place: F(k, l) = sum f(x, y) exp(-2 pi i (k x / width + l y /
 * height)); `inverse`: the other sign, divided by width height. Errors: WEFT_SYSTEM. */
weft_code weft_fourier_transform(double *values, int width, int height, int inverse, weft_error *error);

/* The least size >= n whose transform is fast. */
int weft_fourier_size(int n);

#ifdef __cplusplus
}
#endif

#endif
