#include "compress/run/block_plan.h"

#include "base/integers.h"

#include <stdbool.h>
#include <stdlib.h>

static int whole_blocks(int texels, int side_level)
{
    return (int)(((long)texels + (1L << side_level) - 1) >> side_level);
}

/* Adds the blocks of the square of 2^level texels at (x, y), in the order of a Z. */
static void add_square(weft_block_plan *plan, int width, int height, int level, long x, long y)
{
    if (x >= width || y >= height)
        return;
    if (level == plan->side_level) {
        int side = 1 << level;
        plan->place[plan->count++] =
            (weft_block_place){(int)x, (int)y, weft_smaller(side, width - (int)x), weft_smaller(side, height - (int)y)};
        return;
    }
    long half = 1L << (level - 1);
    for (int part = 0; part < 4; part++)
        add_square(plan, width, height, level - 1, x + part % 2 * half, y + part / 2 * half);
}

static bool in_one_group(const weft_block_place *a, const weft_block_place *b, int level)
{
    return a->x >> level == b->x >> level && a->y >> level == b->y >> level;
}

static int finished_level(const weft_block_plan *plan, size_t i)
{
    int level = weft_smaller(plan->side_level, plan->last_level);
    while (level < plan->last_level &&
           (i + 1 == plan->count || !in_one_group(&plan->place[i], &plan->place[i + 1], level + 1)))
        level++;
    return level;
}

weft_code weft_block_plan_create(int width, int height, int side_level, int last_level, weft_block_plan *plan,
                                 weft_error *error)
{
    *plan = (weft_block_plan){.side_level = side_level, .last_level = last_level};
    size_t blocks = (size_t)whole_blocks(width, side_level) * (size_t)whole_blocks(height, side_level);
    plan->place = calloc(blocks, sizeof *plan->place);
    plan->finished = calloc(blocks, 1);
    if (!plan->place || !plan->finished) {
        weft_block_plan_free(plan);
        return weft_fail_memory(error, "plan of blocks", blocks * sizeof *plan->place);
    }
    int whole = side_level;
    while (1L << whole < (width > height ? width : height))
        whole++;
    add_square(plan, width, height, whole, 0, 0);
    for (size_t i = 0; i < plan->count; i++)
        plan->finished[i] = (uint8_t)finished_level(plan, i);
    return WEFT_OK;
}

void weft_block_plan_free(weft_block_plan *plan)
{
    free(plan->place);
    free(plan->finished);
    *plan = (weft_block_plan){0};
}
