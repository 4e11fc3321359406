#include "btf/material/seen.h"

#include "btf/direction/square_map.h"

#include <stdlib.h>
#include <string.h>

enum { HEADER_WORDS = 8, HEADER_BYTES = 4 * HEADER_WORDS };

static size_t cell_count(const weft_seen *seen)
{
    return (size_t)(WEFT_SEEN_PLACES + seen->level_count) * (size_t)seen->side * (size_t)seen->side;
}

weft_code weft_seen_create(int side, int level_count, weft_seen **result, weft_error *error)
{
    *result = NULL;
    if (side < WEFT_SEEN_LEAST_SIDE || side > WEFT_SEEN_MOST_SIDE || level_count < 1 ||
        level_count > WEFT_SEEN_MOST_LEVELS)
        return weft_fail(error, WEFT_BAD_USAGE, "maps of what is seen of %d x %d cells and %d levels", side, side,
                         level_count);
    weft_seen *seen = calloc(1, sizeof *seen);
    if (!seen)
        return weft_fail_memory(error, "maps of what is seen", sizeof *seen);
    seen->side = side;
    seen->level_count = level_count;
    seen->cell = calloc(cell_count(seen), 1);
    if (!seen->cell) {
        free(seen);
        return weft_fail_memory(error, "maps of what is seen", (size_t)side * (size_t)side);
    }
    *result = seen;
    return WEFT_OK;
}

void weft_seen_free(weft_seen *seen)
{
    if (seen)
        free(seen->cell);
    free(seen);
}

void weft_seen_drop_finest(weft_seen *seen)
{
    size_t map = (size_t)seen->side * (size_t)seen->side;
    uint8_t *places = weft_seen_cells(seen, WEFT_SEEN_PLACES);
    memmove(places, places + map, (size_t)--seen->level_count * map);
    seen->finer_levels++;
}

uint8_t *weft_seen_cells(const weft_seen *seen, int map)
{
    return seen->cell + (size_t)map * (size_t)seen->side * (size_t)seen->side;
}

/* ---- Asking ---- */

static bool is_set(const weft_seen *seen, int map, double x, double y)
{
    int last = seen->side - 1, column = (int)(x * seen->side), row = (int)(y * seen->side);
    column = column < 0 ? 0 : column > last ? last : column;
    row = row < 0 ? 0 : row > last ? last : row;
    return weft_seen_cells(seen, map)[(size_t)row * (size_t)seen->side + (size_t)column] != 0;
}

bool weft_seen_direction(const weft_seen *seen, weft_seen_map map, weft_vec3 direction)
{
    weft_place place = weft_place_of_direction(direction);
    return is_set(seen, (int)map, (double)place.x, (double)place.y);
}

bool weft_seen_place(const weft_seen *seen, double level, double u, double v)
{
    int last = seen->level_count - 1;
    if ((level < 0 && seen->finer_levels > 0) || (level > last && seen->coarser_levels > 0))
        return false;
    double at = fmin(fmax(level, 0), last), x = u - floor(u), y = -v - floor(-v);
    int fine = (int)at;
    return is_set(seen, WEFT_SEEN_PLACES + fine, x, y) &&
           (at <= fine || is_set(seen, WEFT_SEEN_PLACES + fine + 1, x, y));
}

/* ---- The file ---- */

size_t weft_seen_size(const weft_seen *seen)
{
    return HEADER_BYTES + cell_count(seen);
}

void weft_seen_write(const weft_seen *seen, uint8_t *bytes)
{
    const uint32_t word[HEADER_WORDS] = {(uint32_t)seen->side, (uint32_t)seen->level_count,
                                         (uint32_t)seen->finer_levels, (uint32_t)seen->coarser_levels};
    memcpy(bytes, word, sizeof word);
    memcpy(bytes + HEADER_BYTES, seen->cell, cell_count(seen));
}

static const char *fault_of_header(const uint32_t word[HEADER_WORDS], size_t size, int level_count)
{
    if (word[0] < WEFT_SEEN_LEAST_SIDE || word[0] > WEFT_SEEN_MOST_SIDE)
        return "has maps that are not 4 to 128 cells wide";
    if (word[1] != (uint32_t)level_count)
        return "is not of the levels of the material";
    if (word[2] > WEFT_SEEN_MOST_LEVELS || word[3] > WEFT_SEEN_MOST_LEVELS)
        return "says that more levels are missing than a material may have";
    for (int i = 4; i < HEADER_WORDS; i++)
        if (word[i] != 0)
            return "has reserved fields that are not zero";
    const weft_seen shape = {.side = (int)word[0], .level_count = level_count};
    return size == weft_seen_size(&shape) ? NULL : "its size does not fit its counts";
}

static const char *fault_of_bytes(const uint8_t *bytes, size_t size, int level_count, uint32_t word[HEADER_WORDS])
{
    if (size < HEADER_BYTES)
        return "is too short";
    memcpy(word, bytes, HEADER_BYTES);
    const char *fault = fault_of_header(word, size, level_count);
    for (size_t i = HEADER_BYTES; !fault && i < size; i++)
        if (bytes[i] > 1)
            fault = "holds a cell that is neither 0 nor 1";
    return fault;
}

weft_code weft_seen_read(const uint8_t *bytes, size_t size, int level_count, weft_seen **result, const char **fault,
                         weft_error *error)
{
    uint32_t word[HEADER_WORDS] = {0};
    *fault = fault_of_bytes(bytes, size, level_count, word);
    if (*fault)
        return WEFT_BAD_INPUT;
    WEFT_TRY(weft_seen_create((int)word[0], level_count, result, error));
    (*result)->finer_levels = (int)word[2];
    (*result)->coarser_levels = (int)word[3];
    memcpy((*result)->cell, bytes + HEADER_BYTES, size - HEADER_BYTES);
    return WEFT_OK;
}
