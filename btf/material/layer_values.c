#include "btf/material/layer_values.h"

#include <math.h>

enum { RED, GREEN, BLUE, CHANNELS };

/* The images that one is told from; -1: there is none. */
typedef struct weft_image_origins {
    long before, across;
} weft_image_origins;

static weft_image_origins origins_of(const weft_layers *layers, int view, uint32_t image)
{
    const uint32_t *first = layers->first;
    uint32_t place = image - first[view];
    bool has_across = view > 0 && place < first[view] - first[view - 1];
    return (weft_image_origins){place > 0 ? (long)image - 1 : -1, has_across ? (long)(first[view - 1] + place) : -1};
}

static size_t index_of(const weft_layers *layers, long image, int layer)
{
    return CHANNELS * ((size_t)image * (size_t)layers->layer_count + (size_t)layer);
}

static int whole(weft_half value)
{
    return (int)weft_float_of_half(value);
}

/* Green, or how much more than green a channel is. */
static int told(const weft_layers *layers, long image, int layer, int channel)
{
    const weft_half *value = layers->value + index_of(layers, image, layer);
    return channel == GREEN ? whole(value[GREEN]) : whole(value[channel]) - whole(value[GREEN]);
}

/* The mean of the origins, rounded down. */
static int predicted(const weft_layers *layers, weft_image_origins from, int layer, int channel)
{
    if (from.before < 0 && from.across < 0)
        return 0;
    int before = told(layers, from.before < 0 ? from.across : from.before, layer, channel);
    int across = told(layers, from.across < 0 ? from.before : from.across, layer, channel);
    return (before + across) >> 1;
}

/* 0, -1, 1, -2 .. as 0, 1, 2, 3 .. */
static unsigned code_of(int difference)
{
    return difference < 0 ? 2 * (unsigned)-(difference + 1) + 1 : 2 * (unsigned)difference;
}

static int difference_of(unsigned code)
{
    return code & 1 ? -(int)(code >> 1) - 1 : (int)(code >> 1);
}

bool weft_layer_values_are_whole(const weft_layers *layers)
{
    for (size_t i = 0; i < index_of(layers, layers->image_count, 0); i++) {
        float value = weft_float_of_half(layers->value[i]);
        if (!(fabsf(value) <= WEFT_LAYERS_LARGEST_WHOLE) || value != roundf(value))
            return false;
    }
    return true;
}

static void write_image(const weft_layers *layers, int view, uint32_t image, uint8_t *low)
{
    weft_image_origins from = origins_of(layers, view, image);
    uint8_t *high = low + index_of(layers, layers->image_count, 0);
    for (int layer = 0; layer < layers->layer_count; layer++)
        for (int c = 0; c < CHANNELS; c++) {
            size_t at = index_of(layers, image, layer) + (size_t)c;
            unsigned code = code_of(told(layers, image, layer, c) - predicted(layers, from, layer, c));
            low[at] = (uint8_t)code;
            high[at] = (uint8_t)(code >> 8);
        }
}

void weft_layer_values_write(const weft_layers *layers, uint8_t *bytes)
{
    for (int view = 0; view < layers->view_count; view++)
        for (uint32_t image = layers->first[view]; image < layers->first[view + 1]; image++)
            write_image(layers, view, image, bytes);
}

/* False where a value is beyond what may be. */
static bool read_pixel(const uint8_t *low, const uint8_t *high, weft_image_origins from, long image, int layer,
                       weft_layers *layers)
{
    size_t at = index_of(layers, image, layer);
    int value[CHANNELS];
    for (int c = 0; c < CHANNELS; c++)
        value[c] = difference_of(low[at + (size_t)c] | (unsigned)high[at + (size_t)c] << 8) +
                   predicted(layers, from, layer, c);
    value[RED] += value[GREEN];
    value[BLUE] += value[GREEN];
    for (int c = 0; c < CHANNELS; c++) {
        if (value[c] < -WEFT_LAYERS_LARGEST_WHOLE || value[c] > WEFT_LAYERS_LARGEST_WHOLE)
            return false;
        layers->value[at + (size_t)c] = weft_half_of_float((float)value[c]);
    }
    return true;
}

const char *weft_layer_values_read(const uint8_t *bytes, weft_layers *layers)
{
    const uint8_t *high = bytes + index_of(layers, layers->image_count, 0);
    for (int view = 0; view < layers->view_count; view++)
        for (uint32_t image = layers->first[view]; image < layers->first[view + 1]; image++) {
            weft_image_origins from = origins_of(layers, view, image);
            for (int layer = 0; layer < layers->layer_count; layer++)
                if (!read_pixel(bytes, high, from, image, layer, layers))
                    return "holds a value that is no whole number from -2048 to 2048";
        }
    return NULL;
}
