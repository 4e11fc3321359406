#include "btf/material/heights.h"

#include "base/integers.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { HEADER_BYTES = 64, RESERVED_AT = 40 };

/* ---- Memory ---- */

static weft_code allocate(const weft_material_heights *shape, weft_material_heights **result, weft_error *error)
{
    size_t places = (size_t)shape->width * (size_t)shape->height;
    weft_material_heights *heights = malloc(sizeof *heights);
    uint8_t *code = malloc(places);
    if (!heights || !code) {
        free(heights);
        free(code);
        return weft_fail_memory(error, "heights", places);
    }
    *heights = *shape;
    heights->code = code;
    *result = heights;
    return WEFT_OK;
}

void weft_material_heights_free(weft_material_heights *heights)
{
    if (!heights)
        return;
    free(heights->code);
    free(heights);
}

/* ---- What they must be ---- */

/* A nanometre to a thousand kilometres: slopes through heights stay numbers in single precision. */
static bool is_length(double mm)
{
    return mm >= 1e-6 && mm < 1e9;
}

static const char *fault_of_shape(const weft_material_heights *shape)
{
    if (shape->width < 1 || shape->height < 1 || shape->width > WEFT_HEIGHTS_MOST_SIDE ||
        shape->height > WEFT_HEIGHTS_MOST_SIDE)
        return "has too few or too many places";
    if (shape->level_count < 1 || shape->level_count > WEFT_HEIGHTS_MOST_LEVELS)
        return "has heights of no level, or of more than 16";
    if (!is_length(shape->size_mm[0]) || !is_length(shape->size_mm[1]))
        return "holds a size of the material out of range";
    double furthest = 2 * fmax(shape->size_mm[0], shape->size_mm[1]);
    if (!(fabs((double)shape->low_mm) <= furthest && fabs((double)shape->high_mm) <= furthest &&
          shape->low_mm <= shape->high_mm))
        return "holds heights out of range";
    return NULL;
}

/* ---- Codes ---- */

static void find_range(const float *value, size_t places, weft_material_heights *shape)
{
    shape->low_mm = shape->high_mm = value[0];
    for (size_t i = 1; i < places; i++) {
        shape->low_mm = fminf(shape->low_mm, value[i]);
        shape->high_mm = fmaxf(shape->high_mm, value[i]);
    }
    for (size_t i = 0; i < places; i++)
        shape->high_mm = isnan(value[i]) ? NAN : shape->high_mm;
}

weft_code weft_material_heights_create(const float *value, int width, int height, int level_count,
                                       const double size_mm[2], weft_material_heights **result, weft_error *error)
{
    weft_material_heights shape = {
        .width = width, .height = height, .level_count = level_count, .size_mm = {size_mm[0], size_mm[1]}};
    const char *fault = fault_of_shape(&shape);
    size_t places = fault ? 0 : (size_t)width * (size_t)height;
    if (!fault) {
        find_range(value, places, &shape);
        fault = fault_of_shape(&shape);
    }
    if (fault)
        return weft_fail(error, WEFT_BAD_USAGE, "the material %s", fault);
    WEFT_TRY(allocate(&shape, result, error));
    float range = shape.high_mm - shape.low_mm, scale = range > 0 ? WEFT_HEIGHTS_LARGEST_CODE / range : 0;
    for (size_t i = 0; i < places; i++)
        (*result)->code[i] = (uint8_t)lroundf((value[i] - shape.low_mm) * scale);
    return WEFT_OK;
}

float weft_material_height_mm(const weft_material_heights *heights, int x, int y)
{
    float share = (float)heights->code[(size_t)y * (size_t)heights->width + (size_t)x] / WEFT_HEIGHTS_LARGEST_CODE;
    return heights->low_mm + share * (heights->high_mm - heights->low_mm);
}

/* ---- The file ---- */

size_t weft_material_heights_size(const weft_material_heights *heights)
{
    return HEADER_BYTES + (size_t)heights->width * (size_t)heights->height;
}

void weft_material_heights_write(const weft_material_heights *heights, uint8_t *bytes)
{
    const uint32_t whole[4] = {(uint32_t)heights->width, (uint32_t)heights->height, (uint32_t)heights->level_count, 0};
    const float range[2] = {heights->low_mm, heights->high_mm};
    memset(bytes, 0, HEADER_BYTES);
    memcpy(bytes, whole, sizeof whole);
    memcpy(bytes + 16, heights->size_mm, sizeof heights->size_mm);
    memcpy(bytes + 32, range, sizeof range);
    memcpy(bytes + HEADER_BYTES, heights->code, weft_material_heights_size(heights) - HEADER_BYTES);
}

static weft_material_heights shape_of(const uint8_t *bytes)
{
    uint32_t whole[3];
    float range[2];
    weft_material_heights shape;
    memcpy(whole, bytes, sizeof whole);
    memcpy(range, bytes + 32, sizeof range);
    memcpy(shape.size_mm, bytes + 16, sizeof shape.size_mm);
    shape.width = weft_limited_int(whole[0]);
    shape.height = weft_limited_int(whole[1]);
    shape.level_count = weft_limited_int(whole[2]);
    shape.low_mm = range[0];
    shape.high_mm = range[1];
    shape.code = NULL;
    return shape;
}

static const char *fault_of_bytes(const uint8_t *bytes, size_t size, weft_material_heights *shape)
{
    static const uint8_t unused[HEADER_BYTES - RESERVED_AT] = {0};
    if (size < HEADER_BYTES)
        return "is too short";
    if (memcmp(bytes + 12, unused, 4) != 0 || memcmp(bytes + RESERVED_AT, unused, sizeof unused) != 0)
        return "has reserved fields that are not zero";
    *shape = shape_of(bytes);
    const char *fault = fault_of_shape(shape);
    if (!fault && size != weft_material_heights_size(shape))
        fault = "its size does not fit its counts";
    return fault;
}

weft_code weft_material_heights_read(const uint8_t *bytes, size_t size, weft_material_heights **result,
                                     const char **fault, weft_error *error)
{
    weft_material_heights shape = {0};
    *fault = fault_of_bytes(bytes, size, &shape);
    if (*fault)
        return WEFT_BAD_INPUT;
    WEFT_TRY(allocate(&shape, result, error));
    memcpy((*result)->code, bytes + HEADER_BYTES, size - HEADER_BYTES);
    return WEFT_OK;
}
