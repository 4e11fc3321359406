/* Samples of an excerpt told apart where eyes look. */
#ifndef WEFT_COMPARE_TRADEOFF_SAMPLE_KIND_H
#define WEFT_COMPARE_TRADEOFF_SAMPLE_KIND_H

#include "compress/hold_out/excerpt.h"

/* Which samples. A texel's brightness in an image is the mean of its channels, divided by the cosine of the light where
 * the dataset holds that. */
typedef enum weft_sample_kind {
    WEFT_SAMPLES_ALL,
    WEFT_SAMPLES_GRAZING,    /* view or light 52.5 degrees or more from the normal: the ring of 60 degrees or beyond */
    WEFT_SAMPLES_HIGHLIGHTS, /* the brightest twentieth of each texel over all images */
    WEFT_SAMPLES_SHADOWS,    /* the darkest fifth */
    WEFT_SAMPLE_KINDS
} weft_sample_kind;

/* "all", "grazing", "highlights", "shadows". Pure. */
const char *weft_sample_kind_name(weft_sample_kind kind);

/* Of every sample the bits 1 << weft_sample_kind: *kinds [texel][image], which the caller frees, also on failure.
 * Errors: WEFT_SYSTEM for memory. */
weft_code weft_sample_kinds_mark(const weft_excerpt *excerpt, uint8_t **kinds, weft_error *error);

#endif
