/* The values of components as differences, for the file (docs/reference/weft-format.md, 7.3): where they are whole
 * numbers, each is told from that of the image before it and from that of the image at its place in the view before,
 * and red and blue from green, each with a weight. Private to btf/material. */
#ifndef WEFT_BTF_MATERIAL_COMPONENT_VALUES_H
#define WEFT_BTF_MATERIAL_COMPONENT_VALUES_H

#include "btf/material/components.h"

#include <stdbool.h>

enum {
    WEFT_COMPONENTS_LARGEST_WHOLE = 2048, /* half floats hold all whole numbers up to it */
    WEFT_VALUE_WEIGHTS = 3, /* of green at the image, of the image before it, and of the one in the view before */
    WEFT_VALUE_WEIGHT_OF_ONE = 32
};

/* What the three channels of a layer are told with, and whether what they are told from is rounded to the nearest whole
 * number; else down. */
typedef struct weft_value_weights {
    int8_t of[3][WEFT_VALUE_WEIGHTS];
    bool to_nearest;
} weft_value_weights;

/* Whether all values are whole numbers that differences can tell. Pure. */
bool weft_component_values_are_whole(const weft_components *components);

/* The weights of a file without them: all of green, half of each image, rounded down. Pure. */
weft_value_weights weft_value_weights_plain(void);

/* Those that leave the least squares of the differences of layer number `layer`, each to a 32nd of -4 .. 127/32. The
 * values are whole. Pure. */
weft_value_weights weft_value_weights_fit(const weft_components *components, int layer);

/* Writes whole values to bytes [2][image_count][component_count][3]: the low bytes, then the high ones. `weights` has
 * [component_count]. */
void weft_component_values_write(const weft_components *components, const weft_value_weights *weights, uint8_t *bytes);

/* Reads them; `first` is known and right. Returns what is wrong with them ("holds ...") or NULL. */
const char *weft_component_values_read(const uint8_t *bytes, const weft_value_weights *weights,
                                       weft_components *components);

#endif
