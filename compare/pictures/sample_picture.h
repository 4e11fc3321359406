/* Pictures of samples for the eye: exposure, sRGB, differences in false colour. */
#ifndef WEFT_COMPARE_PICTURES_SAMPLE_PICTURE_H
#define WEFT_COMPARE_PICTURES_SAMPLE_PICTURE_H

#include "base/picture/image.h"

/* Factor that brings the 99th percentile of the unmasked values of `image` to 0.9; 1 for a black image. `mask`
 * [height][width] may be NULL. Errors: WEFT_SYSTEM for memory. */
weft_code weft_picture_exposure(const weft_image *image, const uint8_t *mask, double *exposure, weft_error *error);

/* Linear values times `exposure`, sRGB encoded, clamped; masked pixels are grey. `result` is allocated here.
 * Errors: WEFT_SYSTEM for memory. */
weft_code weft_picture_encode(const weft_image *linear, const uint8_t *mask, double exposure, weft_image *result,
                              weft_error *error);

/* Where the colours of differences end. */
#define WEFT_PICTURE_FULL_DIFFERENCE 0.25

/* Mean of the channels of (b - a) x exposure in false colour (weft_difference_colour): red b brighter, blue b darker;
 * masked pixels are grey. */
weft_code weft_picture_difference(const weft_image *a, const weft_image *b, const uint8_t *mask, double exposure,
                                  weft_image *result, weft_error *error);

#endif
