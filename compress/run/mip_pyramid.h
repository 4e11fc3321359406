/* The sums of samples behind the mip levels of one block, and behind the unfinished groups above it. Sums are always
 * those of the four groups below, added in the order of a Z, so that the size of the blocks leaves no trace in them. */
#ifndef WEFT_COMPRESS_RUN_MIP_PYRAMID_H
#define WEFT_COMPRESS_RUN_MIP_PYRAMID_H

#include "base/thread_pool.h"
#include "btf/material/material.h"
#include "compress/run/block_plan.h"
#include "compress/run/group_sums.h"

typedef struct weft_pyramid {
    const weft_block_plan *plan;
    const uint8_t *held_out;
    size_t image_count;
    float *level[WEFT_MATERIAL_MAX_LEVELS]; /* groups: up to the level of the block all of its own, above it one each */
    float *scratch;                         /* [thread_count] groups */
} weft_pyramid;

/* Bytes that a pyramid allocates. Pure. */
uint64_t weft_pyramid_bytes(size_t image_count, int side_level, int last_level, int thread_count);

/* `plan` and `held_out` must outlive the pyramid. Errors: WEFT_SYSTEM. */
weft_code weft_pyramid_create(const weft_block_plan *plan, const uint8_t *held_out, size_t image_count,
                              int thread_count, weft_pyramid *pyramid, weft_error *error);
void weft_pyramid_free(weft_pyramid *pyramid);

/* The texels of a level that belong to a block: x, y, width, height in texels of that level. Pure. */
weft_block_place weft_block_place_at(const weft_block_place *block, int level);

/* Sums the groups of a block from its samples. `pool` has at most thread_count threads. */
void weft_pyramid_sum_block(weft_pyramid *pyramid, weft_thread_pool *pool, const weft_block_samples *block);

/* The sums of the whole block, which weft_pyramid_sum_block has filled in, or the caller. NULL for a material without
 * levels. */
float *weft_pyramid_top(const weft_pyramid *pyramid);

/* Adds the whole block to the group above it, and every group that this finishes to the one above that. */
void weft_pyramid_pass_up(weft_pyramid *pyramid, int finished);

/* Forgets the groups that are finished, once they have been fitted. */
void weft_pyramid_clear_finished(weft_pyramid *pyramid, int finished);

/* The group of texel (x, y) of a level above 0; inside the block, or the one unfinished above it. */
const float *weft_pyramid_group(const weft_pyramid *pyramid, const weft_block_place *block, int level, int x, int y);

#endif
