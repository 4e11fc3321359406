#include "btf/material/component_values.h"

#include <math.h>

enum { RED, GREEN, BLUE, CHANNELS };
enum { OF_GREEN, OF_BEFORE, OF_ACROSS };
enum { SHIFT = 5 /* 2^5 is the weight of one */ };

/* The images that one is told from; -1: there is none. */
typedef struct weft_image_origins {
    long before, across;
} weft_image_origins;

static weft_image_origins origins_of(const weft_components *components, int view, uint32_t image)
{
    const uint32_t *first = components->first;
    uint32_t place = image - first[view];
    bool has_across = view > 0 && place < first[view] - first[view - 1];
    return (weft_image_origins){place > 0 ? (long)image - 1 : -1, has_across ? (long)(first[view - 1] + place) : -1};
}

static size_t index_of(const weft_components *components, long image, int layer)
{
    return CHANNELS * ((size_t)image * (size_t)components->component_count + (size_t)layer);
}

static int whole(weft_half value)
{
    return (int)weft_float_of_half(value);
}

/* The sum of weighted values as a whole number. */
static int whole_of_sum(int sum, const weft_value_weights *weights)
{
    return (sum + (weights->to_nearest ? 1 << (SHIFT - 1) : 0)) >> SHIFT;
}

/* The share of green that another channel is told from. */
static int share_of_green(int green, int channel, const weft_value_weights *weights)
{
    return whole_of_sum(weights->of[channel][OF_GREEN] * green, weights);
}

/* Green, or how much more than its share of green a channel is. */
static int told(const weft_components *components, long image, int layer, int channel,
                const weft_value_weights *weights)
{
    const weft_half *value = components->value + index_of(components, image, layer);
    return whole(value[channel]) - (channel == GREEN ? 0 : share_of_green(whole(value[GREEN]), channel, weights));
}

/* The sum of the weighted origins. */
static int predicted(const weft_components *components, weft_image_origins from, int layer, int channel,
                     const weft_value_weights *weights)
{
    if (from.before < 0 && from.across < 0)
        return 0;
    int before = told(components, from.before < 0 ? from.across : from.before, layer, channel, weights);
    int across = told(components, from.across < 0 ? from.before : from.across, layer, channel, weights);
    const int8_t *weight = weights->of[channel];
    return whole_of_sum(weight[OF_BEFORE] * before + weight[OF_ACROSS] * across, weights);
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

bool weft_component_values_are_whole(const weft_components *components)
{
    for (size_t i = 0; i < index_of(components, components->image_count, 0); i++) {
        float value = weft_float_of_half(components->value[i]);
        if (!(fabsf(value) <= WEFT_COMPONENTS_LARGEST_WHOLE) || value != roundf(value))
            return false;
    }
    return true;
}

/* ---- Weights ---- */

weft_value_weights weft_value_weights_plain(void)
{
    enum { ONE = WEFT_VALUE_WEIGHT_OF_ONE };
    return (weft_value_weights){.of = {{ONE, ONE / 2, ONE / 2}, {0, ONE / 2, ONE / 2}, {ONE, ONE / 2, ONE / 2}}};
}

static int8_t weight_of(double weight)
{
    return (int8_t)weft_clamp(rint(WEFT_VALUE_WEIGHT_OF_ONE * weight), INT8_MIN, INT8_MAX);
}

/* Sums over the images that have both origins: of green against a channel, both without the mean of the origins; and of
 * what a channel tells against its origins. */
typedef struct weight_sums {
    double green_green, green_channel;
    double before_before, before_across, across_across, before_own, across_own;
} weight_sums;

static void add_image(const weft_components *components, weft_image_origins from, long image, int layer, int channel,
                      const weft_value_weights *weights, weight_sums *sums)
{
    const weft_value_weights all = {0};
    double green =
        told(components, image, layer, GREEN, &all) -
        0.5 * (told(components, from.before, layer, GREEN, &all) + told(components, from.across, layer, GREEN, &all));
    double other =
        told(components, image, layer, channel, &all) - 0.5 * (told(components, from.before, layer, channel, &all) +
                                                               told(components, from.across, layer, channel, &all));
    double own = told(components, image, layer, channel, weights);
    double before = told(components, from.before, layer, channel, weights);
    double across = told(components, from.across, layer, channel, weights);
    sums->green_green += green * green;
    sums->green_channel += green * other;
    sums->before_before += before * before;
    sums->before_across += before * across;
    sums->across_across += across * across;
    sums->before_own += before * own;
    sums->across_own += across * own;
}

static weight_sums sum_images(const weft_components *components, int layer, int channel,
                              const weft_value_weights *weights)
{
    weight_sums sums = {0};
    for (int view = 0; view < components->view_count; view++)
        for (uint32_t image = components->first[view]; image < components->first[view + 1]; image++) {
            weft_image_origins from = origins_of(components, view, image);
            if (from.before >= 0 && from.across >= 0)
                add_image(components, from, image, layer, channel, weights, &sums);
        }
    return sums;
}

static void fit_channel(const weft_components *components, int layer, int channel, weft_value_weights *weights)
{
    int8_t *weight = weights->of[channel];
    weight_sums sums;
    if (channel != GREEN) {
        sums = sum_images(components, layer, channel, weights);
        if (sums.green_green > 0)
            weight[OF_GREEN] = weight_of(sums.green_channel / sums.green_green);
    }
    sums = sum_images(components, layer, channel, weights);
    double determinant = sums.before_before * sums.across_across - sums.before_across * sums.before_across;
    if (determinant > 1e-6 * sums.before_before * sums.across_across) {
        weight[OF_BEFORE] =
            weight_of((sums.before_own * sums.across_across - sums.across_own * sums.before_across) / determinant);
        weight[OF_ACROSS] =
            weight_of((sums.across_own * sums.before_before - sums.before_own * sums.before_across) / determinant);
    }
}

weft_value_weights weft_value_weights_fit(const weft_components *components, int layer)
{
    weft_value_weights weights = weft_value_weights_plain();
    weights.to_nearest = true;
    for (int channel = 0; channel < CHANNELS; channel++)
        fit_channel(components, layer, channel, &weights);
    return weights;
}

/* ---- Writing and reading ---- */

static void write_image(const weft_components *components, const weft_value_weights *weights, int view, uint32_t image,
                        uint8_t *low)
{
    weft_image_origins from = origins_of(components, view, image);
    uint8_t *high = low + index_of(components, components->image_count, 0);
    for (int layer = 0; layer < components->component_count; layer++)
        for (int c = 0; c < CHANNELS; c++) {
            const weft_value_weights *own = &weights[layer];
            size_t at = index_of(components, image, layer) + (size_t)c;
            unsigned code =
                code_of(told(components, image, layer, c, own) - predicted(components, from, layer, c, own));
            low[at] = (uint8_t)code;
            high[at] = (uint8_t)(code >> 8);
        }
}

void weft_component_values_write(const weft_components *components, const weft_value_weights *weights, uint8_t *bytes)
{
    for (int view = 0; view < components->view_count; view++)
        for (uint32_t image = components->first[view]; image < components->first[view + 1]; image++)
            write_image(components, weights, view, image, bytes);
}

/* False where a value is beyond what may be. */
static bool read_pixel(const uint8_t *low, const uint8_t *high, const weft_value_weights *weights,
                       weft_image_origins from, long image, int layer, weft_components *components)
{
    size_t at = index_of(components, image, layer);
    int value[CHANNELS];
    for (int c = 0; c < CHANNELS; c++)
        value[c] = difference_of(low[at + (size_t)c] | (unsigned)high[at + (size_t)c] << 8) +
                   predicted(components, from, layer, c, weights);
    value[RED] += share_of_green(value[GREEN], RED, weights);
    value[BLUE] += share_of_green(value[GREEN], BLUE, weights);
    for (int c = 0; c < CHANNELS; c++) {
        if (value[c] < -WEFT_COMPONENTS_LARGEST_WHOLE || value[c] > WEFT_COMPONENTS_LARGEST_WHOLE)
            return false;
        components->value[at + (size_t)c] = weft_half_of_float((float)value[c]);
    }
    return true;
}

const char *weft_component_values_read(const uint8_t *bytes, const weft_value_weights *weights,
                                       weft_components *components)
{
    const uint8_t *high = bytes + index_of(components, components->image_count, 0);
    for (int view = 0; view < components->view_count; view++)
        for (uint32_t image = components->first[view]; image < components->first[view + 1]; image++) {
            weft_image_origins from = origins_of(components, view, image);
            for (int layer = 0; layer < components->component_count; layer++)
                if (!read_pixel(bytes, high, &weights[layer], from, image, layer, components))
                    return "holds a value that is no whole number from -2048 to 2048";
        }
    return NULL;
}
