/* From values at images to square maps: over the lights of each view, then over the views. */
#include "btf/direction/smooth_map.h"
#include "reflectance/layers/half_vector.h"
#include "reflectance/layers/layers.h"

#include <stdlib.h>
#include <string.h>

enum { HORIZON = 24 }; /* places of the horizon where every map is 0 */

/* ---- Over the lights of a view ---- */

static weft_vec3 direction_at(const float *xyz, size_t index)
{
    return weft_vec3_of(xyz[3 * index], xyz[3 * index + 1], xyz[3 * index + 2]);
}

/* Where a light is in the map of a view. */
static weft_place place_of(const weft_layers *layers, weft_vec3 light, weft_vec3 view)
{
    return layers->kind == WEFT_LAYERS_OF_LIGHT ? weft_place_of_direction(light)
                                                : weft_place_of_half_vector(weft_half_vector(light, view));
}

static void place_horizon(const weft_layers *layers, weft_vec3 view, weft_place *place)
{
    for (int i = 0; i < HORIZON; i++) {
        weft_real azimuth = (weft_real)(2 * WEFT_PI * i / HORIZON);
        place[i] = place_of(layers, weft_vec3_of(cos(azimuth), sin(azimuth), 0), view);
    }
}

/* place [images of the view], value [images of the view][layer][3]. */
static void gather_view(const weft_layers *layers, int view, weft_place *place, float *value)
{
    weft_vec3 v = direction_at(layers->view, (size_t)view);
    size_t series = 3 * (size_t)layers->layer_count;
    for (uint32_t image = layers->first[view]; image < layers->first[view + 1]; image++) {
        weft_vec3 light = direction_at(layers->light, image);
        *place++ = place_of(layers, light, v);
        weft_real weight = layers->kind == WEFT_LAYERS_OF_LIGHT ? 1 : weft_dot(light, weft_half_vector(light, v));
        for (size_t i = 0; i < series; i++)
            *value++ =
                (float)weight * layers->scale[i / 3] * weft_float_of_half(layers->value[(size_t)image * series + i]);
    }
}

/* node [light node][layer][3] of one view. */
static weft_code map_view(const weft_layers *layers, int view, float *node, weft_error *error)
{
    size_t images = layers->first[view + 1] - layers->first[view], series = 3 * (size_t)layers->layer_count;
    weft_place *place = malloc((images + HORIZON) * sizeof *place);
    float *value = malloc(images * series * sizeof *value);
    weft_smooth_map *map = NULL;
    weft_code code =
        place && value ? WEFT_OK : weft_fail_memory(error, "maps of layers", images * series * sizeof *value);
    if (code == WEFT_OK) {
        gather_view(layers, view, place, value);
        place_horizon(layers, direction_at(layers->view, (size_t)view), place + images);
        code = weft_smooth_map_create(&(weft_smooth_map_places){.side = layers->light_side,
                                                                .smoothness = layers->light_smoothness,
                                                                .place = place,
                                                                .count = (int)images,
                                                                .zero = place + images,
                                                                .zero_count = HORIZON},
                                      &map, error);
    }
    if (code == WEFT_OK)
        code = weft_smooth_map_solve(map, value, (int)series, node, error);
    weft_smooth_map_free(map);
    free(place);
    free(value);
    return code;
}

/* ---- Over the views ---- */

/* Nodes [light node][layer][3] of each view become those of each node of the map of views. */
static weft_code map_over_views(const weft_layers *layers, const float *of_view, float *node, weft_error *error)
{
    size_t views = (size_t)layers->view_count;
    weft_place *place = malloc(views * sizeof *place);
    if (!place)
        return weft_fail_memory(error, "maps of layers", views * sizeof *place);
    for (size_t i = 0; i < views; i++)
        place[i] = weft_place_of_direction(direction_at(layers->view, i));
    weft_smooth_map *map = NULL;
    weft_code code = weft_smooth_map_create(
        &(weft_smooth_map_places){
            .side = layers->view_side, .smoothness = layers->view_smoothness, .place = place, .count = (int)views},
        &map, error);
    int series = layers->light_side * layers->light_side * 3 * layers->layer_count;
    if (code == WEFT_OK)
        code = weft_smooth_map_solve(map, of_view, series, node, error);
    weft_smooth_map_free(map);
    free(place);
    return code;
}

static weft_code map_views(const weft_layers *layers, size_t row, float *of_view, weft_error *error)
{
    weft_code result = WEFT_OK;
#pragma omp parallel for schedule(dynamic)
    for (int view = 0; view < layers->view_count; view++) {
        weft_error own = {0};
        weft_code code = map_view(layers, view, of_view + (size_t)view * row, &own);
#pragma omp critical(weft_layer_maps)
        if (code != WEFT_OK && result == WEFT_OK) {
            result = code;
            if (error)
                *error = own;
        }
    }
    return result;
}

weft_code weft_layer_maps_create(const weft_layers *layers, weft_layer_maps *maps, weft_error *error)
{
    size_t row = (size_t)layers->light_side * (size_t)layers->light_side * 3 * (size_t)layers->layer_count;
    size_t nodes = (size_t)layers->view_side * (size_t)layers->view_side;
    float *of_view = malloc((size_t)layers->view_count * row * sizeof *of_view);
    *maps = (weft_layer_maps){.layers = layers, .node = malloc(nodes * row * sizeof *maps->node)};
    weft_code code = of_view && maps->node ? map_views(layers, row, of_view, error)
                                           : weft_fail_memory(error, "maps of layers", nodes * row * sizeof *of_view);
    if (code == WEFT_OK)
        code = map_over_views(layers, of_view, maps->node, error);
    free(of_view);
    if (code != WEFT_OK)
        weft_layer_maps_free(maps);
    return code;
}

weft_code weft_layer_maps_keep_views(weft_layer_maps *maps, weft_error *error)
{
    const weft_layers *layers = maps->layers;
    size_t row = (size_t)layers->light_side * (size_t)layers->light_side * 3 * (size_t)layers->layer_count;
    size_t bytes = (size_t)layers->view_count * row * sizeof *maps->node_of_view;
    maps->node_of_view = malloc(bytes);
    return maps->node_of_view ? map_views(layers, row, maps->node_of_view, error)
                              : weft_fail_memory(error, "maps of layers", bytes);
}

void weft_layer_maps_free(weft_layer_maps *maps)
{
    free(maps->node);
    free(maps->node_of_view);
    *maps = (weft_layer_maps){0};
}
