/* The photographs themselves as a model: interpolated between those that are not held out. */
#ifndef WEFT_COMPRESS_HOLD_OUT_INTERPOLATION_H
#define WEFT_COMPRESS_HOLD_OUT_INTERPOLATION_H

#include "compress/hold_out/excerpt.h"

typedef struct weft_interpolation weft_interpolation;

/* For the images image [count], which are held out with others, as held_out [image_count] says; `through`: seen through
 * the surface of the excerpt, which has one. What is given must outlive the result, which the caller frees with
 * weft_interpolation_free. Errors: WEFT_BAD_INPUT for views that cannot be triangulated, WEFT_SYSTEM for memory. */
weft_code weft_interpolation_create(const weft_excerpt *excerpt, const uint8_t *held_out, const int *image, int count,
                                    bool through, weft_interpolation **result, weft_error *error);
void weft_interpolation_free(weft_interpolation *interpolation);

/* What the photographs say of texel (x, y) in those images: prediction [count], in the quantity of the dataset,
 * barycentric between views and, within each, between lights. Samples are divided by the cosine of their own light
 * before. Masked ones take no part; NaN where none is left, and where one of the views saw the place beyond the
 * excerpt. Thread-safe. Errors: WEFT_SYSTEM for memory. */
weft_code weft_interpolation_predict(const weft_interpolation *interpolation, int x, int y, weft_rgb *prediction,
                                     weft_error *error);

#endif
