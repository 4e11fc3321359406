/* The values of linear layers as differences, for the file (docs/reference/weft-format.md, 7.3): where they are whole
 * numbers, each is told from that of the image before it and from that of the image at its place in the view before,
 * and red and blue from green. Private to btf/material. */
#ifndef WEFT_BTF_MATERIAL_LAYER_VALUES_H
#define WEFT_BTF_MATERIAL_LAYER_VALUES_H

#include "btf/material/layers.h"

#include <stdbool.h>

enum { WEFT_LAYERS_LARGEST_WHOLE = 2048 }; /* half floats hold all whole numbers up to it */

/* Whether all values are whole numbers that differences can tell. Pure. */
bool weft_layer_values_are_whole(const weft_layers *layers);

/* Writes whole values to bytes [2][image_count][layer_count][3]: the low bytes, then the high ones. */
void weft_layer_values_write(const weft_layers *layers, uint8_t *bytes);

/* Reads them; `first` is known and right. Returns what is wrong with them ("holds ...") or NULL. */
const char *weft_layer_values_read(const uint8_t *bytes, weft_layers *layers);

#endif
