/* Sums of samples over groups of texels. Of a group a fit needs, for every image, the sums of r, g and b over its valid
 * texels and their number; both add up from the groups of the level below. */
#ifndef WEFT_COMPRESS_RUN_GROUP_SUMS_H
#define WEFT_COMPRESS_RUN_GROUP_SUMS_H

#include "base/half.h"
#include "base/processor.h"

#include <stddef.h>

/* A group is [4 * image_count] floats: the sums [image_count][3], then the counts [image_count]. */

/* The group of one texel: samples [image_count][3], mask [image_count]. Images with held_out[image] != 0 (NULL: none)
 * count nothing. Returns the number of masked samples among the others. */
long weft_group_of_texel(const weft_half *samples, const uint8_t *mask, const uint8_t *held_out, size_t image_count,
                         float *group);

/* Adds a group to another. */
void weft_group_add(const float *from, size_t image_count, float *to);

/* The loops over the samples, for each instruction set: halves as floats, and the sum of two groups. */
#define WEFT_DECLARE_GROUP_KERNELS(set)                                                                                \
    void weft_group_convert_##set(const weft_half *half, size_t count, float *result);                                 \
    void weft_group_accumulate_##set(const float *from, size_t count, float *to)

WEFT_FOR_EACH_SET(WEFT_DECLARE_GROUP_KERNELS);

#endif
