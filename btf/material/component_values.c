/* The values of components by differences: each is predicted from that of the image before it and from that of the
 * image at its place in the view before, and red and blue from green, each with a weight
 * (docs/reference/weft-format.md, 7.3). */
#include "btf/material/component_section.h"

#include <math.h>

enum { RED, GREEN, BLUE, CHANNELS };
enum { OF_GREEN, OF_BEFORE, OF_ACROSS };
enum { SHIFT = 5 /* 2^5 is the weight of one */ };

/* The images that one is predicted from; -1: there is none. */
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

static size_t index_of(const weft_components *components, long image, int component)
{
    return CHANNELS * ((size_t)image * (size_t)components->component_count + (size_t)component);
}

static int whole(const weft_whole_values *values, long image, int component, int channel)
{
    size_t at = index_of(values->components, image, component) + (size_t)channel;
    return (int)rintf(weft_float_of_half(values->components->value[at]) / values->grid[component]);
}

/* The sum of weighted values as a whole number. */
static int whole_of_sum(int sum, const weft_value_weights *weights)
{
    return (sum + (weights->to_nearest ? 1 << (SHIFT - 1) : 0)) >> SHIFT;
}

/* The share of green in the prediction of another channel. */
static int share_of_green(int green, int channel, const weft_value_weights *weights)
{
    return whole_of_sum(weights->of[channel][OF_GREEN] * green, weights);
}

/* Green, or how much more than its share of green a channel is. */
static int beyond_green(const weft_whole_values *values, long image, int component, int channel)
{
    const weft_value_weights *weights = &values->weights[component];
    int value = whole(values, image, component, channel);
    return channel == GREEN ? value : value - share_of_green(whole(values, image, component, GREEN), channel, weights);
}

/* The sum of the weighted origins. */
static int predicted(const weft_whole_values *values, weft_image_origins from, int component, int channel)
{
    if (from.before < 0 && from.across < 0)
        return 0;
    int before = beyond_green(values, from.before < 0 ? from.across : from.before, component, channel);
    int across = beyond_green(values, from.across < 0 ? from.before : from.across, component, channel);
    const weft_value_weights *weights = &values->weights[component];
    return whole_of_sum(weights->of[channel][OF_BEFORE] * before + weights->of[channel][OF_ACROSS] * across, weights);
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

/* ---- Whole numbers ---- */

/* The largest magnitude of a component, and whether all its values are whole. */
static float largest_of(const weft_components *components, int component, bool *are_whole)
{
    float most = 0;
    *are_whole = true;
    for (long image = 0; image < components->image_count; image++)
        for (size_t c = 0; c < CHANNELS; c++) {
            float value = weft_float_of_half(components->value[index_of(components, image, component) + c]);
            most = fmaxf(most, fabsf(value));
            *are_whole = *are_whole && value == rintf(value);
        }
    return most;
}

static float grid_of(const weft_components *components, int component)
{
    bool are_whole;
    float most = largest_of(components, component, &are_whole);
    return are_whole && most <= WEFT_COMPONENTS_LARGEST_WHOLE ? 1 : most / WEFT_COMPONENTS_LARGEST_WHOLE;
}

bool weft_components_have_differences(const weft_components *components)
{
    bool all = true;
    for (int k = 0; k < components->component_count && all; k++)
        all = grid_of(components, k) == 1;
    return all;
}

weft_whole_values weft_whole_values_of(const weft_components *components)
{
    weft_whole_values values = {.components = components};
    for (int k = 0; k < components->component_count; k++) {
        values.grid[k] = grid_of(components, k);
        values.scale[k] = components->scale[k] * values.grid[k];
    }
    return values;
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
 * what a channel is beyond green against its origins. */
typedef struct weight_sums {
    double green_green, green_channel;
    double before_before, before_across, across_across, before_own, across_own;
} weight_sums;

static void add_image(const weft_whole_values *values, weft_image_origins from, long image, int component, int channel,
                      weight_sums *sums)
{
    double green = whole(values, image, component, GREEN) -
                   0.5 * (whole(values, from.before, component, GREEN) + whole(values, from.across, component, GREEN));
    double other = whole(values, image, component, channel) - 0.5 * (whole(values, from.before, component, channel) +
                                                                     whole(values, from.across, component, channel));
    double own = beyond_green(values, image, component, channel);
    double before = beyond_green(values, from.before, component, channel);
    double across = beyond_green(values, from.across, component, channel);
    sums->green_green += green * green;
    sums->green_channel += green * other;
    sums->before_before += before * before;
    sums->before_across += before * across;
    sums->across_across += across * across;
    sums->before_own += before * own;
    sums->across_own += across * own;
}

static weight_sums sum_images(const weft_whole_values *values, int component, int channel)
{
    const weft_components *components = values->components;
    weight_sums sums = {0};
    for (int view = 0; view < components->view_count; view++)
        for (uint32_t image = components->first[view]; image < components->first[view + 1]; image++) {
            weft_image_origins from = origins_of(components, view, image);
            if (from.before >= 0 && from.across >= 0)
                add_image(values, from, image, component, channel, &sums);
        }
    return sums;
}

static void fit_channel(weft_whole_values *values, int component, int channel)
{
    int8_t *weight = values->weights[component].of[channel];
    weight_sums sums;
    if (channel != GREEN) {
        sums = sum_images(values, component, channel);
        if (sums.green_green > 0)
            weight[OF_GREEN] = weight_of(sums.green_channel / sums.green_green);
    }
    sums = sum_images(values, component, channel);
    double determinant = sums.before_before * sums.across_across - sums.before_across * sums.before_across;
    if (determinant > 1e-6 * sums.before_before * sums.across_across) {
        weight[OF_BEFORE] =
            weight_of((sums.before_own * sums.across_across - sums.across_own * sums.before_across) / determinant);
        weight[OF_ACROSS] =
            weight_of((sums.across_own * sums.before_before - sums.before_own * sums.before_across) / determinant);
    }
}

/* Whether all differences of a component have codes of 16 bits. */
static bool have_codes(const weft_whole_values *values, int component)
{
    const weft_components *components = values->components;
    bool all = true;
    for (int view = 0; view < components->view_count; view++)
        for (uint32_t image = components->first[view]; image < components->first[view + 1] && all; image++) {
            weft_image_origins from = origins_of(components, view, image);
            for (int c = 0; c < CHANNELS; c++)
                all = all && code_of(beyond_green(values, image, component, c) -
                                     predicted(values, from, component, c)) <= UINT16_MAX;
        }
    return all;
}

void weft_value_weights_fit(weft_whole_values *values, int component)
{
    weft_value_weights plain = weft_value_weights_plain(), *weights = &values->weights[component];
    plain.to_nearest = true;
    *weights = plain;
    for (int channel = 0; channel < CHANNELS; channel++)
        fit_channel(values, component, channel);
    if (!have_codes(values, component))
        *weights = plain;
}

/* ---- Writing and reading ---- */

static void write_image(const weft_whole_values *values, int view, uint32_t image, uint8_t *low)
{
    const weft_components *components = values->components;
    weft_image_origins from = origins_of(components, view, image);
    uint8_t *high = low + index_of(components, components->image_count, 0);
    for (int k = 0; k < components->component_count; k++)
        for (int c = 0; c < CHANNELS; c++) {
            size_t at = index_of(components, image, k) + (size_t)c;
            unsigned code = code_of(beyond_green(values, image, k, c) - predicted(values, from, k, c));
            low[at] = (uint8_t)code;
            high[at] = (uint8_t)(code >> 8);
        }
}

void weft_component_values_write(const weft_whole_values *values, uint8_t *bytes)
{
    const weft_components *components = values->components;
    for (int view = 0; view < components->view_count; view++)
        for (uint32_t image = components->first[view]; image < components->first[view + 1]; image++)
            write_image(values, view, image, bytes);
}

/* False where a value is beyond what may be. */
static bool read_pixel(const uint8_t *low, const uint8_t *high, const weft_whole_values *values,
                       weft_image_origins from, long image, int component, weft_half *to)
{
    size_t at = index_of(values->components, image, component);
    const weft_value_weights *weights = &values->weights[component];
    int value[CHANNELS];
    for (int c = 0; c < CHANNELS; c++)
        value[c] = difference_of(low[at + (size_t)c] | (unsigned)high[at + (size_t)c] << 8) +
                   predicted(values, from, component, c);
    value[RED] += share_of_green(value[GREEN], RED, weights);
    value[BLUE] += share_of_green(value[GREEN], BLUE, weights);
    for (int c = 0; c < CHANNELS; c++) {
        if (value[c] < -WEFT_COMPONENTS_LARGEST_WHOLE || value[c] > WEFT_COMPONENTS_LARGEST_WHOLE)
            return false;
        to[at + (size_t)c] = weft_half_of_float((float)value[c]);
    }
    return true;
}

const char *weft_component_values_read(const uint8_t *bytes, const weft_value_weights *weights,
                                       weft_components *components)
{
    const uint8_t *high = bytes + index_of(components, components->image_count, 0);
    weft_whole_values values = {.components = components};
    for (int k = 0; k < components->component_count; k++) {
        values.grid[k] = 1;
        values.weights[k] = weights[k];
    }
    for (int view = 0; view < components->view_count; view++)
        for (uint32_t image = components->first[view]; image < components->first[view + 1]; image++) {
            weft_image_origins from = origins_of(components, view, image);
            for (int k = 0; k < components->component_count; k++)
                if (!read_pixel(bytes, high, &values, from, image, k, components->value))
                    return "holds a value that is no whole number from -2048 to 2048";
        }
    return NULL;
}
