/* Photographs as products of two matrices, as the files of Bonn hold them: full matrix factorisation (Koudelka, Magda,
 * Belhumeur and Kriegman 2003), of all channels in one or of each in its own, of linear values or of the logarithm of
 * their luminance and the ratios of U and V to it. Between the directions of the photographs they say what these would
 * say, interpolated. */
#ifndef WEFT_COMPARE_TRADEOFF_FACTORISED_H
#define WEFT_COMPARE_TRADEOFF_FACTORISED_H

#include "compress/hold_out/texel_subset.h"

#include <stdbool.h>

typedef enum weft_factorised_kind {
    WEFT_FACTORISED_LINEAR,
    WEFT_FACTORISED_LOG,
    WEFT_FACTORISED_LINEAR_CHANNELS,
    WEFT_FACTORISED_LOG_CHANNELS,
    WEFT_FACTORISED_KINDS
} weft_factorised_kind;

/* "full matrix, linear", ... Pure. */
const char *weft_factorised_name(weft_factorised_kind kind);

/* Whether the photographs are a grid of far views and lights that are worth it. Pure. */
bool weft_factorised_is_for(const weft_dataset_layout *layout);

/* Bytes of half floats: 16 terms a texel, and as many a photograph and channel of the matrices. Pure. */
double weft_factorised_bytes(weft_factorised_kind kind, double texels, int image_count);

/* Replaces the samples of all images without left_out[image] != 0 by what the product of the matrices says, which are
 * found from at most 1024 of the texels: samples [height][width][image_count][3], at first those of the subset. Errors:
 * WEFT_SYSTEM. */
weft_code weft_factorised_restore(weft_factorised_kind kind, const weft_texel_subset *subset, const uint8_t *left_out,
                                  weft_half *samples, weft_error *error);

#endif
