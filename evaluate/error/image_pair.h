/* One image of a dataset, and what a model makes of it. */
#ifndef WEFT_EVALUATE_ERROR_IMAGE_PAIR_H
#define WEFT_EVALUATE_ERROR_IMAGE_PAIR_H

#include "base/numeric/error_summary.h"
#include "base/picture/image.h"
#include "btf/dataset/dataset.h"
#include "evaluate/error/predictor.h"

/* Freed with weft_image_pair_free. */
typedef struct weft_image_pair {
    int image;
    weft_image sample, prediction; /* in the quantity of the dataset */
    uint8_t *mask;                 /* [height][width] */
} weft_image_pair;

/* Black pictures of the size of the dataset. Errors: WEFT_SYSTEM for memory; the caller frees then too. */
weft_code weft_image_pair_create(const weft_dataset_layout *layout, int image, weft_image_pair *pair,
                                 weft_error *error);
void weft_image_pair_free(weft_image_pair *pair);

/* Fills rows [y, y + rows), for which the predictor is prepared, from a block of the dataset: samples
 * [rows][width][image_count][3], mask [rows][width][image_count]. */
void weft_image_pair_fill(weft_image_pair *pair, const weft_dataset_layout *layout, const weft_predictor *predictor,
                          int y, int rows, const weft_half *samples, const uint8_t *mask);

/* Over all channels of the samples that are not masked. Errors: WEFT_SYSTEM for memory. */
weft_code weft_image_pair_error(const weft_image_pair *pair, weft_error_summary *result, weft_error *error);

#endif
