/* All samples of a dataset of few images in memory: the ground on which the sparse model borrows from neighbours. */
#ifndef WEFT_COMPRESS_SPARSE_FIELD_H
#define WEFT_COMPRESS_SPARSE_FIELD_H

#include "btf/dataset/dataset.h"

/* Owned by the caller. Arrays are [height][width][image_count] (times 3 where so marked); images held out are not in
 * it. */
typedef struct weft_sparse_field {
    int width, height, image_count;
    int level, whole_width, whole_height; /* the mip level, and the texels of level 0 */
    float *light, *view;                  /* x 3: unit directions */
    float *value;                         /* x 3: reflectance times cosine */
    float *weight;                        /* 0: not to be used; the share of valid texels in a group */
    float *image_weight;                  /* [image_count] what an image counts for, 1 in the mean */
} weft_sparse_field;

/* Reads a whole dataset; *masked_count receives the samples that cannot be used. Errors: those of reading, WEFT_SYSTEM
 * for memory. */
weft_code weft_sparse_field_read(weft_dataset *dataset, const uint8_t *held_out, weft_sparse_field *field,
                                 long *masked_count, weft_error *error);

/* The field of the next mip level: means over groups of 2 x 2 texels, each of which counts as the texels of level 0
 * that it stands for (fewer at the right and lower edge). */
weft_code weft_sparse_field_halve(const weft_sparse_field *field, weft_sparse_field *half, weft_error *error);

void weft_sparse_field_free(weft_sparse_field *field);

#endif
