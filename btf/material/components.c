#include "btf/material/components.h"

#include "btf/material/component_values.h"

#include <stdlib.h>
#include <string.h>

enum { CEILING_STEPS = 8, CEILING_OF_ONE = 192, LEAST_SIDE = 4, MOST_SIDE = 64, HEADER_WORDS = 16 };

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

static const char *fault_of_shape(const weft_components *shape)
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
    if (!(shape->light_smoothness > 0 && shape->light_smoothness < 1e6f && shape->view_smoothness > 0 &&
          shape->view_smoothness < 1e6f && shape->least_cosine > 0 && shape->least_cosine <= 1))
        return "holds a smoothness or a cosine out of range";
    if (!(shape->doubt >= 0 && shape->doubt < 1e6f))
        return "holds a doubt out of range";
    return NULL;
}

weft_code weft_components_create(const weft_components *shape, int width, int height, int level_count,
                                 weft_components **result, weft_error *error)
{
    const char *fault = fault_of_shape(shape);
    if (fault || level_count < 1 || level_count > WEFT_COMPONENTS_MAX_LEVELS)
        return weft_fail(error, WEFT_BAD_USAGE, "the material %s", fault ? fault : "has too many levels");
    weft_components *components = calloc(1, sizeof *components);
    if (!components)
        return weft_fail_memory(error, "components", sizeof *components);
    *components = (weft_components){.kind = shape->kind,
                                    .component_count = shape->component_count,
                                    .view_count = shape->view_count,
                                    .image_count = shape->image_count,
                                    .light_side = shape->light_side,
                                    .view_side = shape->view_side,
                                    .light_smoothness = shape->light_smoothness,
                                    .view_smoothness = shape->view_smoothness,
                                    .doubt = shape->doubt,
                                    .least_cosine = shape->least_cosine,
                                    .level_count = level_count};
    weft_code code = allocate_shared(components, error);
    if (code == WEFT_OK)
        code = allocate_levels(components, width, height, error);
    if (code != WEFT_OK)
        weft_components_free(components);
    else
        *result = components;
    return code;
}

void weft_components_free(weft_components *components)
{
    if (!components)
        return;
    free(components->view);
    free(components->light);
    free(components->first);
    free(components->scale);
    free(components->value);
    for (int k = 0; k < components->level_count; k++) {
        free(components->level[k].coefficient);
        free(components->level[k].ceiling);
        free(components->level[k].floor);
    }
    free(components);
}

void weft_components_drop_finest(weft_components *components)
{
    free(components->level[0].coefficient);
    free(components->level[0].ceiling);
    free(components->level[0].floor);
    memmove(components->level, components->level + 1, (size_t)--components->level_count * sizeof *components->level);
}

void weft_components_drop_coarsest(weft_components *components)
{
    weft_components_level *last = &components->level[--components->level_count];
    free(last->coefficient);
    free(last->ceiling);
    free(last->floor);
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

/* ---- The file ---- */

/* The arrays in the order of the file, with their bytes. */
enum { VALUES = 4, ARRAYS };
typedef struct array_list {
    void *array[ARRAYS];
    size_t size[ARRAYS];
} array_list;

static array_list arrays_of(const weft_components *components)
{
    size_t views = (size_t)components->view_count, images = (size_t)components->image_count;
    size_t count = (size_t)components->component_count;
    return (array_list){{components->view, components->light, components->first, components->scale, components->value},
                        {12 * views, 12 * images, 4 * (views + 1), 4 * count, 6 * images * count}};
}

static size_t weights_size(const weft_components *components, weft_components_coding coding)
{
    size_t count = (size_t)components->component_count;
    return coding == WEFT_COMPONENTS_BY_WEIGHTED_DIFFERENCES ? count * sizeof((weft_value_weights){0}.of) : 0;
}

size_t weft_components_header_size(const weft_components *components, weft_components_coding coding)
{
    array_list list = arrays_of(components);
    size_t size = 4 * HEADER_WORDS + weights_size(components, coding);
    for (int i = 0; i < ARRAYS; i++)
        size += list.size[i];
    return size;
}

bool weft_components_have_differences(const weft_components *components)
{
    return weft_component_values_are_whole(components);
}

static void write_differences(const weft_components *components, uint8_t *bytes)
{
    weft_value_weights weights[WEFT_COMPONENTS_MAX];
    size_t size = weights_size(components, WEFT_COMPONENTS_BY_WEIGHTED_DIFFERENCES);
    for (int layer = 0; layer < components->component_count; layer++) {
        weights[layer] = weft_value_weights_fit(components, layer);
        memcpy(bytes + (size_t)layer * sizeof weights->of, weights[layer].of, sizeof weights->of);
    }
    weft_component_values_write(components, weights, bytes + size);
}

void weft_components_header_write(const weft_components *components, weft_components_coding coding, uint8_t *bytes)
{
    const uint32_t whole[] = {(uint32_t)components->kind,       (uint32_t)components->component_count,
                              (uint32_t)components->view_count, (uint32_t)components->image_count,
                              (uint32_t)components->light_side, (uint32_t)components->view_side};
    const float real[] = {components->light_smoothness, components->view_smoothness, components->least_cosine,
                          components->doubt};
    memset(bytes, 0, 4 * HEADER_WORDS);
    memcpy(bytes, whole, sizeof whole);
    memcpy(bytes + sizeof whole, real, sizeof real);
    bytes += 4 * HEADER_WORDS;
    array_list list = arrays_of(components);
    for (int i = 0; i < VALUES; i++) {
        memcpy(bytes, list.array[i], list.size[i]);
        bytes += list.size[i];
    }
    if (coding == WEFT_COMPONENTS_BY_WEIGHTED_DIFFERENCES)
        write_differences(components, bytes);
    else
        memcpy(bytes, list.array[VALUES], list.size[VALUES]);
}

static int limited_int(uint32_t value)
{
    return value > INT32_MAX ? INT32_MAX : (int)value;
}

static weft_components shape_of(const uint8_t *bytes)
{
    uint32_t whole[6];
    float real[4];
    memcpy(whole, bytes, sizeof whole);
    memcpy(real, bytes + sizeof whole, sizeof real);
    return (weft_components){.kind = whole[0] < WEFT_COMPONENTS_KINDS ? (weft_components_kind)whole[0]
                                                                      : WEFT_COMPONENTS_KINDS,
                             .component_count = limited_int(whole[1]),
                             .view_count = limited_int(whole[2]),
                             .image_count = limited_int(whole[3]),
                             .light_side = limited_int(whole[4]),
                             .view_side = limited_int(whole[5]),
                             .light_smoothness = real[0],
                             .view_smoothness = real[1],
                             .least_cosine = real[2],
                             .doubt = real[3]};
}

static const char *fault_of_directions(const float *xyz, int count)
{
    for (int i = 0; i < count; i++) {
        weft_vec3 direction = weft_vec3_of(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
        if (!(fabs(weft_length(direction) - 1) < 1e-3 && direction.z > 0))
            return "holds a direction that is no unit vector above the horizon";
    }
    return NULL;
}

static const char *fault_of_values(const weft_components *components)
{
    const weft_half infinite = 0x7c00;
    size_t count = 3 * (size_t)components->image_count * (size_t)components->component_count;
    for (size_t i = 0; i < count; i++) {
        if ((components->value[i] & infinite) == infinite)
            return "holds a number that is not finite";
    }
    for (int k = 0; k < components->component_count; k++) {
        if (!(components->scale[k] >= 0 && components->scale[k] < 1e6f))
            return "holds a scale out of range";
    }
    return NULL;
}

static const char *fault_of_arrays(const weft_components *components)
{
    const char *fault = fault_of_directions(components->view, components->view_count);
    if (!fault)
        fault = fault_of_directions(components->light, components->image_count);
    if (!fault &&
        (components->first[0] != 0 || components->first[components->view_count] != (uint32_t)components->image_count))
        fault = "has views without all its images";
    for (int i = 0; i < components->view_count && !fault; i++) {
        if (components->first[i] >= components->first[i + 1])
            fault = "has views that are empty or out of order";
    }
    return fault;
}

static const char *read_differences(const uint8_t *bytes, weft_components_coding coding, weft_components *components)
{
    weft_value_weights weights[WEFT_COMPONENTS_MAX];
    size_t size = weights_size(components, coding);
    for (int layer = 0; layer < components->component_count; layer++) {
        weights[layer] = weft_value_weights_plain();
        weights[layer].to_nearest = size > 0;
        if (size > 0)
            memcpy(weights[layer].of, bytes + (size_t)layer * sizeof weights->of, sizeof weights->of);
    }
    return weft_component_values_read(bytes + size, weights, components);
}

static const char *read_arrays(const uint8_t *bytes, weft_components_coding coding, weft_components *components)
{
    array_list list = arrays_of(components);
    for (int i = 0; i < VALUES; i++) {
        memcpy(list.array[i], bytes, list.size[i]);
        bytes += list.size[i];
    }
    const char *fault = fault_of_arrays(components);
    if (fault)
        return fault;
    if (coding != WEFT_COMPONENTS_AS_THEY_ARE)
        fault = read_differences(bytes, coding, components);
    else
        memcpy(list.array[VALUES], bytes, list.size[VALUES]);
    return fault ? fault : fault_of_values(components);
}

weft_code weft_components_header_read(const uint8_t *bytes, size_t size, weft_components_coding coding, int width,
                                      int height, int level_count, weft_components **result, const char **fault,
                                      weft_error *error)
{
    *fault = size < 4 * HEADER_WORDS ? "is too short" : NULL;
    weft_components shape = {0};
    static const uint8_t unused[4 * (HEADER_WORDS - 10)] = {0};
    if (!*fault && memcmp(bytes + 40, unused, sizeof unused) != 0)
        *fault = "has reserved fields that are not zero";
    if (!*fault) {
        shape = shape_of(bytes);
        *fault = fault_of_shape(&shape);
    }
    if (!*fault && size != weft_components_header_size(&shape, coding))
        *fault = "its size does not fit its counts";
    if (*fault)
        return WEFT_BAD_INPUT;
    weft_components *components = NULL;
    WEFT_TRY(weft_components_create(&shape, width, height, level_count, &components, error));
    *fault = read_arrays(bytes + 4 * HEADER_WORDS, coding, components);
    if (*fault) {
        weft_components_free(components);
        return WEFT_BAD_INPUT;
    }
    *result = components;
    return WEFT_OK;
}
