#include "btf/material/visibility.h"

#include "btf/direction/square_map.h"

#include <stdlib.h>
#include <string.h>

enum { HEADER_WORDS = 8, HEADER_BYTES = 4 * HEADER_WORDS };

static size_t cell_count(const weft_material_visibility *visibility)
{
    return (size_t)(WEFT_MATERIAL_VISIBILITY_PLACES + visibility->level_count) * (size_t)visibility->side *
           (size_t)visibility->side;
}

weft_code weft_material_visibility_create(int side, int level_count, weft_material_visibility **result,
                                          weft_error *error)
{
    *result = NULL;
    if (side < WEFT_MATERIAL_VISIBILITY_LEAST_SIDE || side > WEFT_MATERIAL_VISIBILITY_MOST_SIDE || level_count < 1 ||
        level_count > WEFT_MATERIAL_VISIBILITY_MOST_LEVELS)
        return weft_fail(error, WEFT_BAD_USAGE, "maps of visibility of %d x %d cells and %d levels", side, side,
                         level_count);
    weft_material_visibility *visibility = calloc(1, sizeof *visibility);
    if (!visibility)
        return weft_fail_memory(error, "maps of visibility", sizeof *visibility);
    visibility->side = side;
    visibility->level_count = level_count;
    visibility->cell = calloc(cell_count(visibility), 1);
    if (!visibility->cell) {
        free(visibility);
        return weft_fail_memory(error, "maps of visibility", (size_t)side * (size_t)side);
    }
    *result = visibility;
    return WEFT_OK;
}

void weft_material_visibility_free(weft_material_visibility *visibility)
{
    if (visibility)
        free(visibility->cell);
    free(visibility);
}

void weft_material_visibility_drop_finest(weft_material_visibility *visibility)
{
    size_t map = (size_t)visibility->side * (size_t)visibility->side;
    uint8_t *places = weft_material_visibility_cells(visibility, WEFT_MATERIAL_VISIBILITY_PLACES);
    memmove(places, places + map, (size_t)--visibility->level_count * map);
    visibility->finer_levels++;
}

uint8_t *weft_material_visibility_cells(const weft_material_visibility *visibility, int map)
{
    return visibility->cell + (size_t)map * (size_t)visibility->side * (size_t)visibility->side;
}

/* ---- Asking ---- */

static bool is_set(const weft_material_visibility *visibility, int map, double x, double y)
{
    int last = visibility->side - 1, column = (int)(x * visibility->side), row = (int)(y * visibility->side);
    column = column < 0 ? 0 : column > last ? last : column;
    row = row < 0 ? 0 : row > last ? last : row;
    return weft_material_visibility_cells(visibility, map)[(size_t)row * (size_t)visibility->side + (size_t)column] !=
           0;
}

bool weft_material_visibility_direction(const weft_material_visibility *visibility, weft_material_visibility_map map,
                                        weft_vec3 direction)
{
    weft_place place = weft_place_of_direction(direction);
    return is_set(visibility, (int)map, (double)place.x, (double)place.y);
}

bool weft_material_visibility_place(const weft_material_visibility *visibility, double level, double u, double v)
{
    int last = visibility->level_count - 1;
    if ((level < 0 && visibility->finer_levels > 0) || (level > last && visibility->coarser_levels > 0))
        return false;
    double at = fmin(fmax(level, 0), last), x = u - floor(u), y = -v - floor(-v);
    int fine = (int)at;
    return is_set(visibility, WEFT_MATERIAL_VISIBILITY_PLACES + fine, x, y) &&
           (at <= fine || is_set(visibility, WEFT_MATERIAL_VISIBILITY_PLACES + fine + 1, x, y));
}

/* ---- The file ---- */

size_t weft_material_visibility_size(const weft_material_visibility *visibility)
{
    return HEADER_BYTES + cell_count(visibility);
}

void weft_material_visibility_write(const weft_material_visibility *visibility, uint8_t *bytes)
{
    const uint32_t word[HEADER_WORDS] = {(uint32_t)visibility->side, (uint32_t)visibility->level_count,
                                         (uint32_t)visibility->finer_levels, (uint32_t)visibility->coarser_levels};
    memcpy(bytes, word, sizeof word);
    memcpy(bytes + HEADER_BYTES, visibility->cell, cell_count(visibility));
}

static const char *fault_of_header(const uint32_t word[HEADER_WORDS], size_t size, int level_count)
{
    if (word[0] < WEFT_MATERIAL_VISIBILITY_LEAST_SIDE || word[0] > WEFT_MATERIAL_VISIBILITY_MOST_SIDE)
        return "has maps that are not 4 to 128 cells wide";
    if (word[1] != (uint32_t)level_count)
        return "does not fit the levels of the material";
    if (word[2] > WEFT_MATERIAL_VISIBILITY_MOST_LEVELS || word[3] > WEFT_MATERIAL_VISIBILITY_MOST_LEVELS)
        return "says that more levels are missing than a material may have";
    for (int i = 4; i < HEADER_WORDS; i++)
        if (word[i] != 0)
            return "has reserved fields that are not zero";
    const weft_material_visibility shape = {.side = (int)word[0], .level_count = level_count};
    return size == weft_material_visibility_size(&shape) ? NULL : "its size does not fit its counts";
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

weft_code weft_material_visibility_read(const uint8_t *bytes, size_t size, int level_count,
                                        weft_material_visibility **result, const char **fault, weft_error *error)
{
    uint32_t word[HEADER_WORDS] = {0};
    *fault = fault_of_bytes(bytes, size, level_count, word);
    if (*fault)
        return WEFT_BAD_INPUT;
    WEFT_TRY(weft_material_visibility_create((int)word[0], level_count, result, error));
    (*result)->finer_levels = (int)word[2];
    (*result)->coarser_levels = (int)word[3];
    memcpy((*result)->cell, bytes + HEADER_BYTES, size - HEADER_BYTES);
    return WEFT_OK;
}
