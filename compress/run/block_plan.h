/* The order in which the blocks of a dataset are fitted: along a Z (Morton 1966), so that the blocks of a group of
 * texels follow each other and one unfinished group a level is all that must be kept of the levels above. */
#ifndef WEFT_COMPRESS_RUN_BLOCK_PLAN_H
#define WEFT_COMPRESS_RUN_BLOCK_PLAN_H

#include "base/status.h"
#include "compress/run/block_reader.h"

/* Blocks are squares of 2^side_level texels at multiples of that, smaller at the right and lower border. */
typedef struct weft_block_plan {
    int side_level;
    int last_level; /* of the material */
    size_t count;
    weft_block_place *place; /* [count] */
    uint8_t *finished;       /* [count] the highest level whose group ends with this block; at least
                                min(side_level, last_level) */
} weft_block_plan;

/* last_level 0 stands for a material without levels above the first. The caller frees. Errors: WEFT_SYSTEM. */
weft_code weft_block_plan_create(int width, int height, int side_level, int last_level, weft_block_plan *plan,
                                 weft_error *error);
void weft_block_plan_free(weft_block_plan *plan);

#endif
