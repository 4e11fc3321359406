#include "btf/material/component_rounding.h"

#include <math.h>

enum { LARGEST_EXACT = 2048 };

static int8_t *coefficients_of(const weft_components *components, int k, int layer, size_t *texels)
{
    const weft_components_level *level = &components->level[k];
    *texels = (size_t)level->width * (size_t)level->height;
    return level->coefficient + (size_t)(layer / WEFT_COMPONENTS_GROUP) * WEFT_COMPONENTS_GROUP * *texels +
           layer % WEFT_COMPONENTS_GROUP;
}

static weft_half *values_of(const weft_components *components, int layer, size_t i)
{
    return &components->value[3 * ((size_t)components->component_count * (i / 3) + (size_t)layer) + i % 3];
}

static double rms_of_level(const weft_components *components, int k, int layer)
{
    size_t texels;
    const int8_t *c = coefficients_of(components, k, layer, &texels);
    double sum = 0;
    for (size_t i = 0; i < texels; i++)
        sum += (double)(c[WEFT_COMPONENTS_GROUP * i] * c[WEFT_COMPONENTS_GROUP * i]);
    return sqrt(sum / (double)texels);
}

/* Of a layer over the texels of the finest level that has any of it. */
static double coefficient_rms(const weft_components *components, int layer)
{
    double rms = 0;
    for (int k = 0; k < components->level_count && !(rms > 0); k++)
        rms = rms_of_level(components, k, layer);
    return rms;
}

/* Of a layer over images and channels, of a coefficient of 1. */
static double value_rms(const weft_components *components, int layer)
{
    size_t count = 3 * (size_t)components->image_count;
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        double value = (double)weft_float_of_half(*values_of(components, layer, i));
        sum += value * value;
    }
    return (double)components->scale[layer] * sqrt(sum / (double)count);
}

static double largest_value(const weft_components *components, int layer)
{
    double most = 0;
    for (size_t i = 0; i < 3 * (size_t)components->image_count; i++)
        most = fmax(most, fabs((double)weft_float_of_half(*values_of(components, layer, i))));
    return most;
}

/* The values become whole numbers, whose half floats end in zeros, and the scale the grid: no finer than half floats
 * hold whole numbers exactly. */
static void round_layer(weft_components *components, int layer, double asked)
{
    double grid = fmax(asked, largest_value(components, layer) / LARGEST_EXACT);
    for (size_t i = 0; i < 3 * (size_t)components->image_count; i++) {
        weft_half *value = values_of(components, layer, i);
        *value = weft_half_of_float((float)round((double)weft_float_of_half(*value) / grid));
    }
    components->scale[layer] = (float)((double)components->scale[layer] * grid);
}

static long held(long code)
{
    return code > WEFT_COMPONENTS_LARGEST_CODE    ? WEFT_COMPONENTS_LARGEST_CODE
           : code < -WEFT_COMPONENTS_LARGEST_CODE ? -WEFT_COMPONENTS_LARGEST_CODE
                                                  : code;
}

/* How many times a step may be halved before it is finer than those of the codes. */
static int halvings_of(double grid)
{
    return (int)floor(log2(grid) + 1e-6);
}

/* The coefficients become fewer whole numbers, and the scale grows by as much: by the step of the finest level, or
 * where those of coarser levels are `halved` by the last of these that is no finer than 1. So all codes are exact
 * multiples. */
static void round_coefficients(weft_components *components, int layer, double grid, bool halved)
{
    int halvings = halved ? halvings_of(grid) : 0;
    double least = grid * exp2(-halvings);
    for (int k = 0; k < components->level_count; k++) {
        size_t texels;
        int8_t *c = coefficients_of(components, k, layer, &texels);
        int apart = 1 << (k < halvings ? halvings - k : 0);
        for (size_t i = 0; i < texels; i++)
            c[WEFT_COMPONENTS_GROUP * i] =
                (int8_t)held(apart * lround((double)c[WEFT_COMPONENTS_GROUP * i] / (apart * least)));
    }
    components->scale[layer] = (float)((double)components->scale[layer] * least);
}

/* Nothing has any of this layer: what its values are does not matter, but whole numbers let all values be packed. */
static void clear_layer(weft_components *components, int layer)
{
    for (size_t i = 0; i < 3 * (size_t)components->image_count; i++)
        *values_of(components, layer, i) = 0;
}

void weft_components_round_values(double step, weft_components *components)
{
    for (int layer = 0; layer < components->component_count; layer++) {
        double of_value = (double)components->scale[layer] * coefficient_rms(components, layer);
        if (of_value > 0)
            round_layer(components, layer, step / of_value);
        else
            clear_layer(components, layer);
    }
}

void weft_components_round_coefficients(double step, bool halved, weft_components *components)
{
    for (int layer = 0; layer < components->component_count; layer++) {
        double of_coefficient = value_rms(components, layer);
        if (of_coefficient > 0 && step / of_coefficient > 1)
            round_coefficients(components, layer, fmin(step / of_coefficient, WEFT_COMPONENTS_LARGEST_CODE), halved);
    }
}

void weft_components_round(double step, weft_components *components)
{
    weft_components_round_values(step, components);
    weft_components_round_coefficients(step, true, components);
}
