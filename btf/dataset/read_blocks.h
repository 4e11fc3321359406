/* Reading a whole dataset block by block. */
#ifndef WEFT_BTF_DATASET_READ_BLOCKS_H
#define WEFT_BTF_DATASET_READ_BLOCKS_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"

/* The texels of the dataset that are in memory: samples [height][width][image_count][3], mask
 * [height][width][image_count]. */
typedef struct weft_walk_block {
    int x, y, width, height;
    const weft_half *samples;
    const uint8_t *mask;
} weft_walk_block;

typedef void weft_walk_visit(void *context, const weft_walk_block *block);

/* Shows every block to `visit`, from top to bottom; `stage` names the step for the progress. Errors: those of reading;
 * WEFT_SYSTEM. */
weft_code weft_walk_blocks(weft_dataset *dataset, weft_walk_visit *visit, void *context, const char *stage,
                           const weft_progress *progress, weft_error *error);

#endif
