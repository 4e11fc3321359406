#include "player/raw/stream.h"

#include <stdlib.h>
#include <string.h>

enum { BLOCK = WEFT_RAW_BLOCK };

/* A level keeps the rows of one row of blocks, and its first row, which comes again after the last. */
typedef struct level {
    int width, height;
    float *row[BLOCK], *first;
} level;

struct weft_raw_levels {
    const weft_raw_plan *plan;
    int part, channels, level_count;
    weft_raw_take *take;
    void *context;
    level level[WEFT_MIP_LEVELS];
};

static size_t texel_size(const weft_raw_levels *levels)
{
    return (size_t)levels->channels * (size_t)levels->plan->tiles[levels->part].count;
}

static weft_code allocate_level(level *l, size_t size, weft_error *error)
{
    size *= (size_t)l->width;
    l->first = malloc(size * sizeof *l->first);
    bool complete = l->first;
    for (int y = 0; y < BLOCK; y++) {
        l->row[y] = malloc(size * sizeof *l->first);
        complete &= l->row[y] != NULL;
    }
    return complete ? WEFT_OK : weft_fail_memory(error, "rows of samples", (BLOCK + 1) * size * sizeof *l->first);
}

weft_code weft_raw_levels_create(const weft_raw_plan *plan, int part, int width, int height, weft_raw_take *take,
                                 void *context, weft_raw_levels **result, weft_error *error)
{
    weft_raw_levels *levels = calloc(1, sizeof *levels);
    *result = levels;
    if (!levels)
        return weft_fail_memory(error, "levels", sizeof *levels);
    levels->plan = plan;
    levels->part = part;
    levels->take = take;
    levels->context = context;
    levels->channels = part == WEFT_RAW_SAMPLES ? 3 : 1;
    levels->level_count = plan->skipped_levels + plan->layout.level_count;
    for (int k = 0; k < levels->level_count; k++) {
        levels->level[k].width = width;
        levels->level[k].height = height;
        WEFT_TRY(allocate_level(&levels->level[k], texel_size(levels), error));
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    return WEFT_OK;
}

void weft_raw_levels_free(weft_raw_levels *levels)
{
    if (!levels)
        return;
    for (int k = 0; k < WEFT_MIP_LEVELS; k++) {
        for (int y = 0; y < BLOCK; y++)
            free(levels->level[k].row[y]);
        free(levels->level[k].first);
    }
    free(levels);
}

float *weft_raw_levels_row(weft_raw_levels *levels, int y)
{
    return levels->level[0].row[y % BLOCK];
}

/* ---- Strips ---- */

static int blocks_for(int texels)
{
    return (texels + 1 + BLOCK - 1) / BLOCK;
}

static weft_code give_strip(const weft_raw_levels *levels, const weft_raw_rows *rows, weft_raw_strip strip,
                            weft_error *error)
{
    const weft_raw_tiles *tiles = &levels->plan->tiles[levels->part];
    int first = strip.column * tiles->layers, count = tiles->count - first, blocks = blocks_for(rows->width);
    strip.bytes = (size_t)blocks * (size_t)tiles->layers * weft_raw_block_bytes(tiles->format);
    strip.texels = calloc(1, strip.bytes);
    if (!strip.texels)
        return weft_fail_memory(error, "rows of samples", strip.bytes);
    weft_raw_store(tiles->format, rows, first, count < tiles->layers ? count : tiles->layers, blocks, strip.texels);
    return levels->take(levels->context, &strip, error);
}

/* The row of blocks in which row y of texels lies, as far as it came; after the last row comes the first. */
static weft_code give_blocks(const weft_raw_levels *levels, int k, int y, weft_error *error)
{
    const level *l = &levels->level[k];
    const weft_raw_tiles *tiles = &levels->plan->tiles[levels->part];
    weft_raw_rows rows = {.width = l->width, .channels = levels->channels, .image_count = tiles->count};
    for (int i = 0; i < BLOCK; i++)
        rows.row[i] = y / BLOCK * BLOCK + i < l->height ? l->row[i] : l->first;
    for (int column = 0; column < tiles->columns; column++) {
        weft_raw_strip strip = {levels->part, k - levels->plan->skipped_levels, column, y / BLOCK, 0, NULL};
        WEFT_TRY(give_strip(levels, &rows, strip, error));
    }
    return WEFT_OK;
}

static weft_code give_complete_blocks(const weft_raw_levels *levels, int k, int y, weft_error *error)
{
    bool last = y == levels->level[k].height - 1;
    if (y % BLOCK == BLOCK - 1 || last)
        WEFT_TRY(give_blocks(levels, k, y, error));
    if (y % BLOCK == BLOCK - 1 && last)
        WEFT_TRY(give_blocks(levels, k, y + 1, error));
    return WEFT_OK;
}

/* ---- Levels ---- */

/* Mean of the two rows (or one, at an odd edge) and of pairs of texels along them. */
static void halve(const weft_raw_levels *levels, int k, const float *upper, const float *lower, float *result)
{
    size_t size = texel_size(levels);
    for (int x = 0; x < levels->level[k + 1].width; x++) {
        size_t left = (size_t)(2 * x) * size;
        size_t right = 2 * x + 1 < levels->level[k].width ? left + size : left;
        for (size_t i = 0; i < size; i++)
            result[(size_t)x * size + i] =
                (upper[left + i] + upper[right + i] + lower[left + i] + lower[right + i]) / 4;
    }
}

static weft_code push_row(weft_raw_levels *levels, int k, int y, weft_error *error)
{
    const level *l = &levels->level[k];
    if (y == 0)
        memcpy(l->first, l->row[0], (size_t)l->width * texel_size(levels) * sizeof(float));
    if (k >= levels->plan->skipped_levels)
        WEFT_TRY(give_complete_blocks(levels, k, y, error));
    if (k + 1 >= levels->level_count || (y % 2 == 0 && y < l->height - 1))
        return WEFT_OK;
    halve(levels, k, l->row[y / 2 * 2 % BLOCK], l->row[y % BLOCK], levels->level[k + 1].row[y / 2 % BLOCK]);
    return push_row(levels, k + 1, y / 2, error);
}

weft_code weft_raw_levels_push(weft_raw_levels *levels, int y, weft_error *error)
{
    return push_row(levels, 0, y, error);
}
