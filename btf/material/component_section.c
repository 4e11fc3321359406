#include "btf/material/component_section.h"

#include "base/integers.h"

#include <math.h>
#include <string.h>

enum { HEADER_WORDS = 16, SMOOTH_WORDS = 10, KRIGED_WORDS = 14 };

/* The arrays in the order of the file, with their bytes. */
enum { SCALES = 3, LENGTHS, NUGGETS, VALUES, ARRAYS };
typedef struct array_list {
    void *array[ARRAYS];
    size_t size[ARRAYS];
} array_list;

static array_list arrays_of(const weft_components *components)
{
    size_t views = (size_t)components->view_count, images = (size_t)components->image_count;
    size_t count = (size_t)components->component_count;
    size_t kriged = weft_components_are_kriged(components->kind) ? 4 * count : 0;
    return (array_list){{components->view, components->light, components->first, components->scale, components->length,
                         components->nugget, components->value},
                        {12 * views, 12 * images, 4 * (views + 1), 4 * count, kriged, kriged, 6 * images * count}};
}

static size_t weights_size(const weft_components *components, weft_value_coding coding)
{
    size_t count = (size_t)components->component_count;
    return coding == WEFT_VALUES_BY_WEIGHTED_DIFFERENCES ? count * sizeof((weft_value_weights){0}.of) : 0;
}

size_t weft_components_section_size(const weft_components *components, weft_value_coding coding)
{
    array_list list = arrays_of(components);
    size_t size = 4 * HEADER_WORDS + weights_size(components, coding);
    for (int i = 0; i < ARRAYS; i++)
        size += list.size[i];
    return size;
}

static void write_shape(const weft_components *components, uint8_t *bytes)
{
    const uint32_t whole[] = {(uint32_t)components->kind,       (uint32_t)components->component_count,
                              (uint32_t)components->view_count, (uint32_t)components->image_count,
                              (uint32_t)components->light_side, (uint32_t)components->view_side};
    const float smooth[] = {components->light_smoothness, components->view_smoothness, components->least_cosine,
                            components->view_variance_threshold},
                kriged[] = {components->trend,        components->view_length,    components->least_cosine,
                            components->view_nugget,  components->exponent,       components->incidence_power,
                            components->cosine_power, components->least_incidence};
    bool is_kriged = weft_components_are_kriged(components->kind);
    memset(bytes, 0, 4 * HEADER_WORDS);
    memcpy(bytes, whole, sizeof whole);
    memcpy(bytes + sizeof whole, is_kriged ? kriged : smooth, is_kriged ? sizeof kriged : sizeof smooth);
}

void weft_components_section_write(const weft_components *components, uint8_t *bytes)
{
    weft_whole_values values = weft_whole_values_of(components);
    array_list list = arrays_of(components);
    write_shape(components, bytes);
    bytes += 4 * HEADER_WORDS;
    list.array[SCALES] = values.scale;
    for (int i = 0; i < VALUES; i++) {
        memcpy(bytes, list.array[i], list.size[i]);
        bytes += list.size[i];
    }
    for (int k = 0; k < components->component_count; k++) {
        weft_value_weights_fit(&values, k);
        memcpy(bytes, values.weights[k].of, sizeof values.weights[k].of);
        bytes += sizeof values.weights[k].of;
    }
    weft_component_values_write(&values, bytes);
}

static weft_components shape_of(const uint8_t *bytes)
{
    uint32_t whole[6];
    float real[8];
    memcpy(whole, bytes, sizeof whole);
    memcpy(real, bytes + sizeof whole, sizeof real);
    weft_components shape = {.kind = whole[0] < WEFT_COMPONENTS_KINDS ? (weft_components_kind)whole[0]
                                                                      : WEFT_COMPONENTS_KINDS,
                             .component_count = weft_limited_int(whole[1]),
                             .view_count = weft_limited_int(whole[2]),
                             .image_count = weft_limited_int(whole[3]),
                             .light_side = weft_limited_int(whole[4]),
                             .view_side = weft_limited_int(whole[5]),
                             .least_cosine = real[2],
                             .exponent = real[4],
                             .incidence_power = real[5],
                             .cosine_power = real[6],
                             .least_incidence = real[7]};
    if (weft_components_are_kriged(shape.kind)) {
        shape.trend = real[0];
        shape.view_length = real[1];
        shape.view_nugget = real[3];
    } else {
        shape.light_smoothness = real[0];
        shape.view_smoothness = real[1];
        shape.view_variance_threshold = real[3];
    }
    return shape;
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

static const char *fault_of_lengths(const weft_components *components)
{
    for (int k = 0; k < components->component_count; k++) {
        float length = components->length[k], nugget = components->nugget[k];
        if (!(length >= 1e-3f && length <= 1e3f && nugget >= 1e-6f && nugget <= 1e3f))
            return "holds a length or a nugget out of range";
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
        else if (weft_components_are_kriged(components->kind) &&
                 components->first[i + 1] - components->first[i] > WEFT_KRIGED_MAX_LIGHTS)
            fault = "has too many lights in a view for kriged maps";
    }
    if (!fault && weft_components_are_kriged(components->kind))
        fault = fault_of_lengths(components);
    return fault;
}

static const char *read_differences(const uint8_t *bytes, weft_value_coding coding, weft_components *components)
{
    weft_value_weights weights[WEFT_COMPONENTS_MAX];
    size_t size = weights_size(components, coding);
    for (int k = 0; k < components->component_count; k++) {
        weights[k] = weft_value_weights_plain();
        weights[k].to_nearest = size > 0;
        if (size > 0)
            memcpy(weights[k].of, bytes + (size_t)k * sizeof weights[k].of, sizeof weights[k].of);
    }
    return weft_component_values_read(bytes + size, weights, components);
}

static const char *read_arrays(const uint8_t *bytes, weft_value_coding coding, weft_components *components)
{
    array_list list = arrays_of(components);
    for (int i = 0; i < VALUES; i++) {
        memcpy(list.array[i], bytes, list.size[i]);
        bytes += list.size[i];
    }
    const char *fault = fault_of_arrays(components);
    if (fault)
        return fault;
    if (coding != WEFT_VALUES_AS_HALVES)
        fault = read_differences(bytes, coding, components);
    else
        memcpy(list.array[VALUES], bytes, list.size[VALUES]);
    return fault ? fault : fault_of_values(components);
}

static const char *fault_of_header(const uint8_t *bytes, weft_value_coding coding, const weft_components *shape)
{
    static const uint8_t unused[4 * (HEADER_WORDS - SMOOTH_WORDS)] = {0};
    bool kriged = shape->kind < WEFT_COMPONENTS_KINDS && weft_components_are_kriged(shape->kind);
    size_t used = kriged ? KRIGED_WORDS : SMOOTH_WORDS;
    if (memcmp(bytes + 4 * used, unused, 4 * (HEADER_WORDS - used)) != 0)
        return "has reserved fields that are not zero";
    if (kriged && coding != WEFT_VALUES_BY_WEIGHTED_DIFFERENCES)
        return "holds components of an unknown kind";
    return weft_components_fault_of_shape(shape);
}

weft_code weft_components_section_read(const uint8_t *bytes, size_t size, weft_value_coding coding, int width,
                                       int height, int level_count, weft_components **result, const char **fault,
                                       weft_error *error)
{
    *fault = size < 4 * HEADER_WORDS ? "is too short" : NULL;
    weft_components shape = {0};
    if (!*fault) {
        shape = shape_of(bytes);
        *fault = fault_of_header(bytes, coding, &shape);
    }
    if (!*fault && size != weft_components_section_size(&shape, coding))
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
