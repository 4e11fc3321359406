#include "compress/run/mip_pyramid.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Groups kept of a level, in blocks of 2^side_level texels. */
static size_t kept_groups(int side_level, int level)
{
    return level > side_level ? 1 : (size_t)1 << 2 * (side_level - level);
}

/* Level 0 is kept only where it is all of a block: texels are fitted from their samples. */
static int lowest_level(int side_level)
{
    return side_level > 0 ? 1 : 0;
}

uint64_t weft_pyramid_bytes(size_t image_count, int side_level, int last_level, int thread_count)
{
    size_t groups = (size_t)thread_count;
    for (int k = lowest_level(side_level); last_level > 0 && k <= last_level; k++)
        groups += kept_groups(side_level, k);
    return groups * 4 * image_count * sizeof(float);
}

weft_code weft_pyramid_create(const weft_block_plan *plan, const uint8_t *held_out, size_t image_count,
                              int thread_count, weft_pyramid *pyramid, weft_error *error)
{
    *pyramid = (weft_pyramid){.plan = plan, .held_out = held_out, .image_count = image_count};
    size_t floats = 4 * image_count;
    pyramid->scratch = calloc((size_t)thread_count * floats, sizeof(float));
    bool complete = pyramid->scratch != NULL;
    for (int k = lowest_level(plan->side_level); plan->last_level > 0 && k <= plan->last_level; k++) {
        pyramid->level[k] = calloc(kept_groups(plan->side_level, k) * floats, sizeof(float));
        complete = complete && pyramid->level[k];
    }
    if (complete)
        return WEFT_OK;
    weft_pyramid_free(pyramid);
    return weft_fail_memory(error, "sums of samples",
                            weft_pyramid_bytes(image_count, plan->side_level, plan->last_level, thread_count));
}

void weft_pyramid_free(weft_pyramid *pyramid)
{
    for (int k = 0; k < WEFT_MATERIAL_MAX_LEVELS; k++)
        free(pyramid->level[k]);
    free(pyramid->scratch);
    *pyramid = (weft_pyramid){0};
}

weft_block_place weft_block_place_at(const weft_block_place *block, int level)
{
    int x = block->x >> level, y = block->y >> level;
    return (weft_block_place){x, y, ((block->x + block->width - 1) >> level) - x + 1,
                              ((block->y + block->height - 1) >> level) - y + 1};
}

/* ---- Inside a block ---- */

static void add_texel(const weft_pyramid *pyramid, const weft_block_samples *block, int x, int y, int thread,
                      float *group)
{
    size_t images = pyramid->image_count;
    size_t at = ((size_t)y * (size_t)block->place.width + (size_t)x) * images;
    float *texel = pyramid->scratch + (size_t)thread * 4 * images;
    weft_group_of_texel(block->samples + 3 * at, block->mask + at, pyramid->held_out, images, texel);
    weft_group_add(texel, images, group);
}

/* The groups of one level of a block. */
typedef struct level_sums {
    const weft_pyramid *pyramid;
    const weft_block_samples *block;
    int level;
    weft_block_place own, below; /* the block at this level and the one below */
} level_sums;

/* A group from the four (or fewer) below it. */
static void sum_group(void *context, long item, int thread)
{
    const level_sums *sums = context;
    const weft_pyramid *pyramid = sums->pyramid;
    size_t floats = 4 * pyramid->image_count;
    int x = (int)(item % sums->own.width), y = (int)(item / sums->own.width);
    float *group = pyramid->level[sums->level] + (size_t)item * floats;
    memset(group, 0, floats * sizeof *group);
    for (int row = 2 * y; row < 2 * y + 2 && row < sums->below.height; row++) {
        for (int column = 2 * x; column < 2 * x + 2 && column < sums->below.width; column++) {
            size_t child = (size_t)row * (size_t)sums->below.width + (size_t)column;
            if (sums->level == 1)
                add_texel(pyramid, sums->block, column, row, thread, group);
            else
                weft_group_add(pyramid->level[sums->level - 1] + child * floats, pyramid->image_count, group);
        }
    }
}

void weft_pyramid_sum_block(weft_pyramid *pyramid, weft_thread_pool *pool, const weft_block_samples *block)
{
    const weft_block_plan *plan = pyramid->plan;
    if (plan->last_level == 0)
        return;
    if (plan->side_level == 0) {
        memset(pyramid->level[0], 0, 4 * pyramid->image_count * sizeof(float));
        add_texel(pyramid, block, 0, 0, 0, pyramid->level[0]);
    }
    for (int level = 1; level <= plan->side_level; level++) {
        level_sums sums = {pyramid, block, level, weft_block_place_at(&block->place, level),
                           weft_block_place_at(&block->place, level - 1)};
        weft_thread_pool_run(pool, sum_group, &sums, (long)sums.own.width * sums.own.height);
    }
}

/* ---- Above it ---- */

float *weft_pyramid_top(const weft_pyramid *pyramid)
{
    return pyramid->plan->last_level > 0 ? pyramid->level[pyramid->plan->side_level] : NULL;
}

void weft_pyramid_pass_up(weft_pyramid *pyramid, int finished)
{
    const weft_block_plan *plan = pyramid->plan;
    for (int k = plan->side_level; k <= finished && k < plan->last_level; k++)
        weft_group_add(pyramid->level[k], pyramid->image_count, pyramid->level[k + 1]);
}

void weft_pyramid_clear_finished(weft_pyramid *pyramid, int finished)
{
    for (int k = pyramid->plan->side_level + 1; k <= finished; k++)
        memset(pyramid->level[k], 0, 4 * pyramid->image_count * sizeof(float));
}

const float *weft_pyramid_group(const weft_pyramid *pyramid, const weft_block_place *block, int level, int x, int y)
{
    if (level > pyramid->plan->side_level)
        return pyramid->level[level];
    weft_block_place own = weft_block_place_at(block, level);
    size_t at = (size_t)(y - own.y) * (size_t)own.width + (size_t)(x - own.x);
    return pyramid->level[level] + at * 4 * pyramid->image_count;
}
