/* What all texels share of components, for the file (docs/reference/weft-format.md, 7.1 and 7.3). Private to
 * btf/material. */
#ifndef WEFT_BTF_MATERIAL_COMPONENT_SECTION_H
#define WEFT_BTF_MATERIAL_COMPONENT_SECTION_H

#include "btf/material/components.h"

/* How a section has the values; only the last one is written. */
typedef enum weft_value_coding {
    WEFT_VALUES_AS_HALVES,      /* version 1 */
    WEFT_VALUES_BY_DIFFERENCES, /* version 1 */
    WEFT_VALUES_BY_WEIGHTED_DIFFERENCES
} weft_value_coding;

/* What is wrong with the counts and numbers of components, or NULL. Pure. */
const char *weft_components_fault_of_shape(const weft_components *shape);

/* Bytes of the section. Pure. */
size_t weft_components_section_size(const weft_components *components, weft_value_coding coding);

/* Writes the section to bytes [weft_components_section_size], by weighted differences. Values that are no whole numbers
 * of -2048 .. 2048 are rounded to 2048ths of the largest of their component, and its scale is written to match. */
void weft_components_section_write(const weft_components *components, uint8_t *bytes);

/* Reads a section of `size` bytes for a material of width x height texels and so many levels. `fault` receives
 * what is wrong with it ("holds ...") or NULL. Errors: WEFT_BAD_INPUT where something is, WEFT_SYSTEM. */
weft_code weft_components_section_read(const uint8_t *bytes, size_t size, weft_value_coding coding, int width,
                                       int height, int level_count, weft_components **result, const char **fault,
                                       weft_error *error);

/* ---- Values as differences (component_values.c) ---- */

enum {
    WEFT_COMPONENTS_LARGEST_WHOLE = 2048, /* half floats hold all whole numbers up to it */
    WEFT_VALUE_WEIGHTS = 3, /* of green at the image, of the image before it, and of the one in the view before */
    WEFT_VALUE_WEIGHT_OF_ONE = 32
};

/* How the three channels of a component are predicted, and whether a prediction is rounded to the nearest whole
 * number; else down. */
typedef struct weft_value_weights {
    int8_t of[3][WEFT_VALUE_WEIGHTS];
    bool to_nearest;
} weft_value_weights;

/* The values of components as whole numbers: those of component k divided by grid[k]. */
typedef struct weft_whole_values {
    const weft_components *components;
    float grid[WEFT_COMPONENTS_MAX], scale[WEFT_COMPONENTS_MAX]; /* scale: of the whole numbers */
    weft_value_weights weights[WEFT_COMPONENTS_MAX];
} weft_whole_values;

/* A grid of 1 where all values of a component are whole, else of a 2048th of the largest; weights are not set. Pure. */
weft_whole_values weft_whole_values_of(const weft_components *components);

/* The weights of a file without them: all of green, half of each image, rounded down. Pure. */
weft_value_weights weft_value_weights_plain(void);

/* Sets the weights of a component that leave the least squares of the differences, each to a 32nd of -4 .. 127/32. */
void weft_value_weights_fit(weft_whole_values *values, int component);

/* Writes the differences to bytes [2][image_count][component_count][3]: the low bytes, then the high ones. */
void weft_component_values_write(const weft_whole_values *values, uint8_t *bytes);

/* Reads them into components->value; components->first is known and right. Returns what is wrong with them ("holds
 * ...") or NULL. */
const char *weft_component_values_read(const uint8_t *bytes, const weft_value_weights *weights,
                                       weft_components *components);

#endif
