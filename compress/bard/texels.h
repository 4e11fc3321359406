/* BARD of some texels that are in memory (reflectance/bard/bard.h). */
#ifndef WEFT_COMPRESS_BARD_TEXELS_H
#define WEFT_COMPRESS_BARD_TEXELS_H

#include "btf/dataset/dataset.h"
#include "compress/bard/predict.h"

/* How many photographs under the light along the normal a layout has, one a view, without those with left_out[image] !=
 * 0 (NULL: none); 0 where it has no use for them: a near dataset, no such light, too few views. Thread-safe. */
int weft_bard_count_photographs(const weft_dataset_layout *layout, const uint8_t *left_out);

/* Predicts every image of every texel from these photographs: `samples` [texel_count][image_count][3] and `mask`
 * [texel_count][image_count] are measured, predicted [texel_count][image_count][3] is in the quantity of the layout; a
 * photograph that is used predicts itself. NaN for a texel without a valid photograph. Errors: WEFT_BAD_INPUT where
 * weft_bard_count_photographs is 0; WEFT_SYSTEM for memory. */
weft_code weft_bard_predict_texels(const weft_dataset_layout *layout, const uint8_t *left_out,
                                   const weft_bard_options *options, const weft_half *samples, const uint8_t *mask,
                                   long texel_count, weft_half *predicted, weft_error *error);

#endif
