#include "btf/material/components.h"

#include "btf/material/component_section.h"

#include <stdlib.h>
#include <string.h>

enum { CEILING_STEPS = 8, CEILING_OF_ONE = 192, LEAST_SIDE = 4, MOST_SIDE = 64 };

/* ---- Memory ---- */

static weft_code allocate(void *array, size_t count, size_t size, weft_error *error)
{
    void *bytes = calloc(count > 0 ? count : 1, size);
    memcpy(array, &bytes, sizeof bytes);
    return bytes ? WEFT_OK : weft_fail_memory(error, "components", count * size);
}

static weft_code allocate_shared(weft_components *components, weft_error *error)
{
    size_t views = (size_t)components->view_count, images = (size_t)components->image_count;
    size_t count = (size_t)components->component_count;
    WEFT_TRY(allocate(&components->view, 3 * views, sizeof *components->view, error));
    WEFT_TRY(allocate(&components->light, 3 * images, sizeof *components->light, error));
    WEFT_TRY(allocate(&components->first, views + 1, sizeof *components->first, error));
    WEFT_TRY(allocate(&components->scale, count, sizeof *components->scale, error));
    WEFT_TRY(allocate(&components->length, count, sizeof *components->length, error));
    WEFT_TRY(allocate(&components->nugget, count, sizeof *components->nugget, error));
    return allocate(&components->value, 3 * images * count, sizeof *components->value, error);
}

static weft_code allocate_levels(weft_components *components, int width, int height, weft_error *error)
{
    for (int k = 0; k < components->level_count; k++) {
        weft_components_level *level = &components->level[k];
        level->width = width;
        level->height = height;
        size_t texels = (size_t)width * (size_t)height;
        WEFT_TRY(allocate(&level->coefficient, texels * (size_t)components->component_count, 1, error));
        WEFT_TRY(allocate(&level->ceiling, weft_ceiling_count(width, height), 1, error));
        WEFT_TRY(allocate(&level->floor, 3 * weft_ceiling_count(width, height), 1, error));
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    return WEFT_OK;
}

static const char *fault_of_smoothness(const weft_components *shape)
{
    if (!(shape->light_smoothness > 0 && shape->light_smoothness < 1e6f && shape->view_smoothness > 0 &&
          shape->view_smoothness < 1e6f))
        return "holds a smoothness or a cosine out of range";
    if (!(shape->view_variance_threshold >= 0 && shape->view_variance_threshold < 1e6f))
        return "holds a view-variance threshold out of range";
    return NULL;
}

static bool is_within(float value, float least, float most)
{
    return value >= least && value <= most;
}

static const char *fault_of_kriging(const weft_components *shape)
{
    if (shape->view_count > WEFT_KRIGED_MAX_VIEWS)
        return "has too many views for kriged maps";
    if (shape->light_side > WEFT_KRIGED_MAX_SIDE || shape->view_side > WEFT_KRIGED_MAX_SIDE)
        return "has kriged maps that are more than 32 nodes wide";
    if (!is_within(shape->exponent, 1, 4) || !is_within(shape->incidence_power, 0, 4) ||
        !is_within(shape->cosine_power, -2, 2) || !is_within(shape->least_incidence, 1e-3f, 1))
        return "holds an exponent or a power out of range";
    if (!is_within(shape->view_length, 1e-3f, 1e3f) || !is_within(shape->view_nugget, 1e-6f, 1e3f) ||
        !is_within(shape->trend, 0, 1e3f))
        return "holds a length, a nugget or a trend out of range";
    return NULL;
}

const char *weft_components_fault_of_shape(const weft_components *shape)
{
    if (shape->kind < 0 || shape->kind >= WEFT_COMPONENTS_KINDS)
        return "holds components of an unknown kind";
    if (shape->component_count < WEFT_COMPONENTS_GROUP || shape->component_count > WEFT_COMPONENTS_MAX ||
        shape->component_count % WEFT_COMPONENTS_GROUP != 0)
        return "has a number of components that is no multiple of 4 from 4 to 64";
    if (shape->view_count < 1 || shape->view_count > WEFT_COMPONENTS_MAX_VIEWS || shape->image_count < 1 ||
        shape->image_count > WEFT_COMPONENTS_MAX_IMAGES)
        return "has too few or too many views or images";
    if (shape->light_side < LEAST_SIDE || shape->light_side > MOST_SIDE || shape->view_side < LEAST_SIDE ||
        shape->view_side > MOST_SIDE)
        return "has maps that are not 4 to 64 nodes wide";
    if (!(shape->least_cosine > 0 && shape->least_cosine <= 1))
        return "holds a smoothness or a cosine out of range";
    return weft_components_are_kriged(shape->kind) ? fault_of_kriging(shape) : fault_of_smoothness(shape);
}

void weft_components_set_implied(weft_components *components)
{
    components->exponent = 1;
    components->incidence_power = (float)(components->kind - WEFT_COMPONENTS_OF_LIGHT);
    components->cosine_power = 0;
    components->least_incidence = WEFT_LEAST_INCIDENCE;
}

static void copy_numbers(const weft_components *shape, weft_components *components)
{
    *components = (weft_components){.kind = shape->kind,
                                    .component_count = shape->component_count,
                                    .view_count = shape->view_count,
                                    .image_count = shape->image_count,
                                    .light_side = shape->light_side,
                                    .view_side = shape->view_side,
                                    .light_smoothness = shape->light_smoothness,
                                    .view_smoothness = shape->view_smoothness,
                                    .exponent = shape->exponent,
                                    .incidence_power = shape->incidence_power,
                                    .cosine_power = shape->cosine_power,
                                    .least_incidence = shape->least_incidence,
                                    .view_length = shape->view_length,
                                    .view_nugget = shape->view_nugget,
                                    .trend = shape->trend,
                                    .view_variance_threshold = shape->view_variance_threshold,
                                    .least_cosine = shape->least_cosine};
    if (!weft_components_are_kriged(shape->kind))
        weft_components_set_implied(components);
}

weft_code weft_components_create(const weft_components *shape, int width, int height, int level_count,
                                 weft_components **result, weft_error *error)
{
    const char *fault = weft_components_fault_of_shape(shape);
    if (fault || level_count < 1 || level_count > WEFT_COMPONENTS_MAX_LEVELS)
        return weft_fail(error, WEFT_BAD_USAGE, "the material %s", fault ? fault : "has too many levels");
    weft_components *components = calloc(1, sizeof *components);
    if (!components)
        return weft_fail_memory(error, "components", sizeof *components);
    copy_numbers(shape, components);
    components->level_count = level_count;
    weft_code code = allocate_shared(components, error);
    if (code == WEFT_OK)
        code = allocate_levels(components, width, height, error);
    if (code != WEFT_OK)
        weft_components_free(components);
    else
        *result = components;
    return code;
}

static void free_level(weft_components_level *level)
{
    free(level->coefficient);
    free(level->ceiling);
    free(level->floor);
}

void weft_components_free(weft_components *components)
{
    if (!components)
        return;
    free(components->view);
    free(components->light);
    free(components->first);
    free(components->scale);
    free(components->length);
    free(components->nugget);
    free(components->value);
    for (int k = 0; k < components->level_count; k++)
        free_level(&components->level[k]);
    free(components);
}

void weft_components_drop_finest(weft_components *components)
{
    free_level(&components->level[0]);
    memmove(components->level, components->level + 1, (size_t)--components->level_count * sizeof *components->level);
}

void weft_components_drop_coarsest(weft_components *components)
{
    weft_components_level *last = &components->level[--components->level_count];
    free_level(last);
    *last = (weft_components_level){0};
}

/* ---- Ceilings and floors ---- */

float weft_ceiling_of_code(uint8_t code)
{
    return exp2f((float)(code - CEILING_OF_ONE) / CEILING_STEPS);
}

uint8_t weft_ceiling_code(float value)
{
    int code = value > 0 ? (int)floorf(CEILING_OF_ONE + CEILING_STEPS * log2f(value)) : 0;
    code = code < 0 ? 0 : code > 255 ? 255 : code;
    while (code < 255 && weft_ceiling_of_code((uint8_t)code) < value)
        code++;
    return (uint8_t)code;
}

float weft_floor_of_code(uint8_t code)
{
    uint32_t bits = (uint32_t)(WEFT_FLOOR_FIRST + code) << WEFT_FLOOR_SHIFT;
    float value;
    memcpy(&value, &bits, sizeof value);
    return code > 0 ? value : 0;
}

size_t weft_ceiling_count(int width, int height)
{
    size_t columns = ((size_t)width + WEFT_CEILING_SIDE - 1) / WEFT_CEILING_SIDE;
    return columns * (((size_t)height + WEFT_CEILING_SIDE - 1) / WEFT_CEILING_SIDE);
}
