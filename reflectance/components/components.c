#include "reflectance/components/components.h"

#include "btf/direction/square_map.h"
#include "btf/material/neighbours.h"

#include <string.h>

/* ---- Factors ---- */

static weft_square_cell light_cell(const weft_components *components, weft_vec3 light, weft_vec3 half_vector)
{
    weft_place place = weft_components_are_over_half_vector(components->kind) ? weft_place_of_half_vector(half_vector)
                                                                              : weft_place_of_direction(light);
    return weft_square_cell_at(place, components->light_side);
}

weft_real weft_components_divisor(const weft_components *components, weft_vec3 light, weft_vec3 half_vector)
{
    if (!weft_components_are_over_half_vector(components->kind))
        return 1;
    weft_real incidence = fmax(weft_dot(light, half_vector), (weft_real)components->least_incidence);
    weft_real cosine = fmax(light.z, (weft_real)WEFT_LEAST_COSINE);
    weft_real exponent = (weft_real)components->exponent;
    return pow(incidence, (weft_real)components->incidence_power / exponent) *
           pow(cosine, (weft_real)components->cosine_power / exponent);
}

void weft_component_factors(const weft_component_maps *maps, weft_vec3 light, weft_vec3 view, float *factor)
{
    const weft_components *components = maps->components;
    size_t series = 3 * (size_t)components->component_count;
    memset(factor, 0, series * sizeof *factor);
    if (!(light.z > 0 && view.z > 0))
        return;
    weft_vec3 half_vector = weft_half_vector(light, view);
    weft_square_cell outer = weft_square_cell_at(weft_place_of_direction(view), components->view_side),
                     inner = light_cell(components, light, half_vector);
    weft_real divisor = weft_components_divisor(components, light, half_vector);
    size_t light_nodes = (size_t)components->light_side * (size_t)components->light_side;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            const float *node = maps->node + ((size_t)outer.index[i] * light_nodes + (size_t)inner.index[j]) * series;
            float weight = (float)(outer.weight[i] * inner.weight[j] / divisor);
            for (size_t k = 0; k < series; k++)
                factor[k] += weight * node[k];
        }
}

void weft_component_factors_of_view(const weft_component_maps *maps, weft_vec3 light, int view, float *factor)
{
    const weft_components *components = maps->components;
    size_t series = 3 * (size_t)components->component_count,
           nodes = (size_t)components->light_side * (size_t)components->light_side;
    memset(factor, 0, series * sizeof *factor);
    if (!(light.z > 0))
        return;
    const float *xyz = components->view + 3 * (size_t)view;
    weft_vec3 half_vector = weft_half_vector(light, weft_vec3_of(xyz[0], xyz[1], xyz[2]));
    weft_square_cell inner = light_cell(components, light, half_vector);
    weft_real divisor = weft_components_divisor(components, light, half_vector);
    for (int j = 0; j < 4; j++) {
        const float *node = maps->node_of_view + ((size_t)view * nodes + (size_t)inner.index[j]) * series;
        float weight = (float)(inner.weight[j] / divisor);
        for (size_t k = 0; k < series; k++)
            factor[k] += weight * node[k];
    }
}

/* ---- Texels ---- */

static weft_rgb combine(int count, const float *coefficient, const float *factor)
{
    float r = 0, g = 0, b = 0;
    for (int k = 0; k < count; k++) {
        r += coefficient[k] * factor[3 * k];
        g += coefficient[k] * factor[3 * k + 1];
        b += coefficient[k] * factor[3 * k + 2];
    }
    return (weft_rgb){r, g, b};
}

/* What the values of a texel are held to, under a light from above. */
typedef struct bounds {
    weft_real floor[3], ceiling;
} bounds;

static bounds bounds_at(const weft_components_level *level, int x, int y)
{
    int columns = (level->width + WEFT_CEILING_SIDE - 1) / WEFT_CEILING_SIDE;
    size_t square = (size_t)(y / WEFT_CEILING_SIDE) * (size_t)columns + (size_t)(x / WEFT_CEILING_SIDE);
    const uint8_t *floor_code = level->floor + 3 * square;
    return (bounds){{(weft_real)weft_floor_of_code(floor_code[0]), (weft_real)weft_floor_of_code(floor_code[1]),
                     (weft_real)weft_floor_of_code(floor_code[2])},
                    (weft_real)weft_ceiling_of_code(level->ceiling[square])};
}

/* Decoded, and then held: channels of kriged maps are scaled down alike, so that what is too bright keeps its hue. */
static weft_rgb decoded(const weft_components *components, weft_rgb sum, const bounds *within, weft_real light_z)
{
    weft_real most = within->ceiling * fmin((weft_real)1, light_z / (weft_real)components->least_cosine);
    const weft_real *least = within->floor;
    weft_rgb value = {fmax((weft_real)weft_decoded(components->exponent, (float)sum.r), least[0] * light_z),
                      fmax((weft_real)weft_decoded(components->exponent, (float)sum.g), least[1] * light_z),
                      fmax((weft_real)weft_decoded(components->exponent, (float)sum.b), least[2] * light_z)};
    if (!weft_components_are_kriged(components->kind))
        return (weft_rgb){fmin(value.r, most), fmin(value.g, most), fmin(value.b, most)};
    weft_real brightest = fmax(value.r, fmax(value.g, value.b));
    weft_real scale = brightest > most ? most / brightest : 1;
    return (weft_rgb){scale * value.r, scale * value.g, scale * value.b};
}

/* Adds `weight` times the coefficients of texel (x, y). */
static void add_coefficients(const weft_components_level *level, int count, int x, int y, float weight, float *sum)
{
    size_t texels = (size_t)level->width * (size_t)level->height;
    size_t texel = (size_t)y * (size_t)level->width + (size_t)x;
    for (int group = 0; group < count / WEFT_COMPONENTS_GROUP; group++) {
        const int8_t *code = level->coefficient + WEFT_COMPONENTS_GROUP * ((size_t)group * texels + texel);
        for (int i = 0; i < WEFT_COMPONENTS_GROUP; i++)
            sum[WEFT_COMPONENTS_GROUP * group + i] += weight * (float)code[i];
    }
}

weft_rgb weft_components_texel(const weft_components *components, int count, const float *factor, int level, int x,
                               int y, weft_real light_z)
{
    const weft_components_level *at = &components->level[level];
    float coefficient[WEFT_COMPONENTS_MAX] = {0};
    if (!(light_z > 0))
        return (weft_rgb){0};
    add_coefficients(at, count, x, y, 1, coefficient);
    bounds within = bounds_at(at, x, y);
    return decoded(components, combine(count, coefficient, factor), &within, light_z);
}

/* ---- Texture coordinates ---- */

/* Adds the coefficients of a level and returns its bounds. */
static bounds add_level(const weft_components_level *level, int count, weft_real u, weft_real v, float weight,
                        float *sum)
{
    weft_neighbours column = weft_neighbours_of(u, level->width), row = weft_neighbours_of(-v, level->height);
    float right = (float)column.share, below = (float)row.share;
    float upper = weight * (1 - below), lower = weight * below;
    add_coefficients(level, count, column.low, row.low, upper * (1 - right), sum);
    add_coefficients(level, count, column.high, row.low, upper * right, sum);
    add_coefficients(level, count, column.low, row.high, lower * (1 - right), sum);
    add_coefficients(level, count, column.high, row.high, lower * right, sum);
    return bounds_at(level, right < 0.5f ? column.low : column.high, below < 0.5f ? row.low : row.high);
}

weft_rgb weft_components_sample(const weft_components *components, int count, const float *factor, weft_real level,
                                weft_real u, weft_real v, weft_real light_z)
{
    float coefficient[WEFT_COMPONENTS_MAX] = {0};
    if (!(light_z > 0 && isfinite(u) && isfinite(v)))
        return (weft_rgb){0};
    weft_real clamped = level > 0 ? fmin(level, (weft_real)(components->level_count - 1)) : 0;
    int fine = (int)clamped;
    float share = (float)(clamped - (weft_real)fine);
    bounds within = add_level(&components->level[fine], count, u, v, 1 - share, coefficient);
    if (share > 0)
        add_level(&components->level[fine + 1], count, u, v, share, coefficient);
    return decoded(components, combine(count, coefficient, factor), &within, light_z);
}

/* ---- Through heights ---- */

static weft_rgb sum_of(weft_rgb sum, weft_real weight, weft_rgb value)
{
    return (weft_rgb){sum.r + weight * value.r, sum.g + weight * value.g, sum.b + weight * value.b};
}

weft_rgb weft_components_sample_through(const weft_component_maps *maps, const weft_material_relief *relief, int count,
                                        weft_real level, weft_real u, weft_real v, weft_vec3 light, weft_vec3 view)
{
    weft_rgb sum = {0};
    float factor[3 * WEFT_COMPONENTS_MAX];
    weft_real share = weft_material_relief_share(relief, level);
    if (!(light.z > 0 && view.z > 0 && isfinite(u) && isfinite(v)))
        return sum;
    if (share < 1) {
        weft_component_factors(maps, light, view, factor);
        sum = sum_of(sum, 1 - share, weft_components_sample(maps->components, count, factor, level, u, v, light.z));
    }
    if (!(share > 0))
        return sum;
    int index[3];
    weft_relief_tap tap[3];
    weft_material_relief_taps(relief, u, v, view, index, tap);
    for (int i = 0; i < 3; i++) {
        if (!(tap[i].weight > 0))
            continue;
        weft_component_factors_of_view(maps, light, index[i], factor);
        sum = sum_of(sum, share * tap[i].weight,
                     weft_components_sample(maps->components, count, factor, level, tap[i].u, tap[i].v, light.z));
    }
    return sum;
}
