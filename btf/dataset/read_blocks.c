#include "btf/dataset/read_blocks.h"

#include "base/integers.h"
#include "btf/dataset/write_blocks.h"

#include <stdlib.h>

typedef struct walking {
    weft_dataset *dataset;
    weft_walk_visit *visit;
    void *context;
    int width, height; /* of a block */
    weft_half *samples;
    uint8_t *mask;
} walking;

static weft_code walk_row(const walking *walk, int y, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(walk->dataset);
    int height = weft_smaller(walk->height, layout->height - y);
    for (int x = 0; x < layout->width; x += walk->width) {
        weft_walk_block block = {x, y, weft_smaller(walk->width, layout->width - x), height, walk->samples, walk->mask};
        WEFT_TRY(weft_dataset_read_block(walk->dataset, x, y, block.width, height, walk->samples, walk->mask, error));
        walk->visit(walk->context, &block);
    }
    return WEFT_OK;
}

weft_code weft_walk_blocks(weft_dataset *dataset, weft_walk_visit *visit, void *context, const char *stage,
                           const weft_progress *progress, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    walking walk = {.dataset = dataset, .visit = visit, .context = context};
    weft_dataset_block_size(layout, &walk.width, &walk.height);
    size_t samples = (size_t)walk.width * (size_t)walk.height * (size_t)layout->image_count;
    walk.samples = malloc(3 * samples * sizeof *walk.samples);
    walk.mask = malloc(samples);
    weft_code code = walk.samples && walk.mask ? WEFT_OK : weft_fail_memory(error, "block of texels", 7 * samples);
    weft_progress_report(progress, stage, 0, layout->height);
    for (int y = 0; code == WEFT_OK && y < layout->height; y += walk.height) {
        code = walk_row(&walk, y, error);
        weft_progress_report(progress, stage, weft_smaller(y + walk.height, layout->height), layout->height);
    }
    free(walk.samples);
    free(walk.mask);
    return code;
}
