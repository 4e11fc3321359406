/* From values at images to square maps: over the lights of each view, then over the views. */
#include "btf/direction/kriged_map.h"
#include "btf/direction/smooth_map.h"
#include "reflectance/components/components.h"

#include <stdlib.h>
#include <string.h>

enum { HORIZON = 24 }; /* places of the horizon where every map is 0 */

/* ---- Over the lights of a view ---- */

static weft_vec3 direction_at(const float *xyz, size_t index)
{
    return weft_vec3_of(xyz[3 * index], xyz[3 * index + 1], xyz[3 * index + 2]);
}

/* Where a light is in the map of a view. */
static weft_place place_of(const weft_components *components, weft_vec3 light, weft_vec3 view)
{
    return weft_components_are_over_half_vector(components->kind)
               ? weft_place_of_half_vector(weft_half_vector(light, view))
               : weft_place_of_direction(light);
}

static void place_horizon(const weft_components *components, weft_vec3 view, weft_place *place)
{
    for (int i = 0; i < HORIZON; i++) {
        weft_real azimuth = (weft_real)(2 * WEFT_PI * i / HORIZON);
        place[i] = place_of(components, weft_vec3_of(cos(azimuth), sin(azimuth), 0), view);
    }
}

/* Layers of which the maps of a view are found together; of kriged ones these share their length and nugget. */
typedef struct layers {
    size_t first, count;
    weft_kriged_grid grid; /* of kriged ones */
} layers;

/* value [images of the view][some layers][3] times the divisor of each. */
static void gather_view(const weft_components *components, const layers *some, int view, float *value)
{
    weft_vec3 v = direction_at(components->view, (size_t)view);
    size_t series = 3 * (size_t)components->component_count, last = 3 * (some->first + some->count);
    for (uint32_t image = components->first[view]; image < components->first[view + 1]; image++) {
        weft_vec3 light = direction_at(components->light, image);
        weft_real weight = weft_components_divisor(components, light, weft_half_vector(light, v));
        for (size_t i = 3 * some->first; i < last; i++)
            *value++ = (float)weight * components->scale[i / 3] *
                       weft_float_of_half(components->value[(size_t)image * series + i]);
    }
}

static void place_images(const weft_components *components, int view, weft_place *place)
{
    weft_vec3 v = direction_at(components->view, (size_t)view);
    for (uint32_t image = components->first[view]; image < components->first[view + 1]; image++)
        *place++ = place_of(components, direction_at(components->light, image), v);
    place_horizon(components, v, place);
}

/* Places of the images, and behind them those of the horizon. */
static weft_code smooth_view(const weft_components *components, const weft_place *place, int images, const float *value,
                             float *node, float *variance, weft_error *error)
{
    weft_smooth_map *map = NULL;
    WEFT_TRY(weft_smooth_map_create(&(weft_smooth_map_places){.side = components->light_side,
                                                              .smoothness = components->light_smoothness,
                                                              .place = place,
                                                              .count = images,
                                                              .zero = place + images,
                                                              .zero_count = HORIZON},
                                    &map, error));
    weft_code code = weft_smooth_map_solve(map, value, 3 * components->component_count, node, error);
    if (code == WEFT_OK && variance)
        code = weft_smooth_map_variances(map, variance, error);
    weft_smooth_map_free(map);
    return code;
}

static weft_code krige_view(const weft_components *components, const layers *some, const weft_place *place, int images,
                            const float *value, float *node, float *variance, weft_error *error)
{
    weft_kriged_map *map = NULL;
    WEFT_TRY(weft_kriged_map_create(
        &(weft_kriged_places){
            .grid = &some->grid, .place = place, .count = images, .nugget = components->nugget[some->first]},
        &map, error));
    weft_code code = weft_kriged_map_solve(map, value, 3 * (int)some->count, node, error);
    if (code == WEFT_OK && variance)
        code = weft_kriged_map_variances(map, variance, error);
    weft_kriged_map_free(map);
    return code;
}

/* node [light node][layer][3] of one view gets some of its layers; variance [light node], or NULL. */
static weft_code map_view(const weft_components *components, const layers *some, int view, float *node, float *variance,
                          weft_error *error)
{
    size_t images = components->first[view + 1] - components->first[view], series = 3 * some->count,
           nodes = (size_t)components->light_side * (size_t)components->light_side,
           row = 3 * (size_t)components->component_count;
    weft_place *place = malloc((images + HORIZON) * sizeof *place);
    float *value = malloc(images * series * sizeof *value), *solved = malloc(nodes * series * sizeof *solved);
    weft_code code = place && value && solved
                         ? WEFT_OK
                         : weft_fail_memory(error, "maps of components", nodes * series * sizeof *solved);
    if (code == WEFT_OK) {
        place_images(components, view, place);
        gather_view(components, some, view, value);
        code = weft_components_are_kriged(components->kind)
                   ? krige_view(components, some, place, (int)images, value, solved, variance, error)
                   : smooth_view(components, place, (int)images, value, solved, variance, error);
    }
    for (size_t i = 0; i < nodes && code == WEFT_OK; i++)
        memcpy(node + i * row + 3 * some->first, solved + i * series, series * sizeof *node);
    free(place);
    free(value);
    free(solved);
    return code;
}

static size_t light_nodes(const weft_components *components)
{
    return (size_t)components->light_side * (size_t)components->light_side;
}

static weft_code map_some_layers(const weft_components *components, const layers *some, float *of_view, float *variance,
                                 weft_error *error)
{
    size_t nodes = light_nodes(components), row = nodes * 3 * (size_t)components->component_count;
    weft_code result = WEFT_OK;
#pragma omp parallel for schedule(dynamic)
    for (int view = 0; view < components->view_count; view++) {
        weft_error own = {0};
        weft_code code = map_view(components, some, view, of_view + (size_t)view * row,
                                  variance ? variance + (size_t)view * nodes : NULL, &own);
#pragma omp critical(weft_component_maps)
        if (code != WEFT_OK && result == WEFT_OK) {
            result = code;
            if (error)
                *error = own;
        }
    }
    return result;
}

/* All smooth ones are alike. */
static size_t end_of_alike(const weft_components *components, size_t first)
{
    size_t last = first + 1, count = (size_t)components->component_count;
    while (last < count &&
           (!weft_components_are_kriged(components->kind) || (components->length[last] == components->length[first] &&
                                                              components->nugget[last] == components->nugget[first])))
        last++;
    return last;
}

/* The variances are those of the first layers, which say most. */
static weft_code map_views(const weft_components *components, float *of_view, float *variance, weft_error *error)
{
    weft_code code = WEFT_OK;
    for (size_t first = 0, last; first < (size_t)components->component_count && code == WEFT_OK; first = last) {
        last = end_of_alike(components, first);
        layers some = {.first = first, .count = last - first};
        if (weft_components_are_kriged(components->kind))
            WEFT_TRY(weft_kriged_grid_create(components->light_side,
                                             weft_components_are_over_half_vector(components->kind),
                                             components->length[first], components->trend, &some.grid, error));
        code = map_some_layers(components, &some, of_view, first == 0 ? variance : NULL, error);
        weft_kriged_grid_free(&some.grid);
    }
    return code;
}

/* ---- Over the views ---- */

/* What the images say, view by view: nodes [view][light node][layer][3], and their variances [view][light node]. */
typedef struct view_maps {
    const weft_components *components;
    weft_place *place;     /* [view] */
    weft_kriged_grid grid; /* of the views, for kriged maps */
    float *node, *variance;
} view_maps;

static void free_view_maps(view_maps *of)
{
    free(of->place);
    weft_kriged_grid_free(&of->grid);
    free(of->node);
    free(of->variance);
}

static weft_code make_view_maps(const weft_components *components, view_maps *of, weft_error *error)
{
    size_t views = (size_t)components->view_count, nodes = views * light_nodes(components);
    size_t values = nodes * 3 * (size_t)components->component_count;
    *of = (view_maps){.components = components,
                      .place = malloc(views * sizeof *of->place),
                      .node = malloc(values * sizeof *of->node),
                      .variance = malloc(nodes * sizeof *of->variance)};
    if (!of->place || !of->node || !of->variance)
        return weft_fail_memory(error, "maps of components", values * sizeof *of->node);
    for (size_t i = 0; i < views; i++)
        of->place[i] = weft_place_of_direction(direction_at(components->view, i));
    bool is_kriged = weft_components_are_kriged(components->kind);
    if (is_kriged)
        WEFT_TRY(weft_kriged_grid_create(components->view_side, false, components->view_length, 0, &of->grid, error));
    bool are_weighed = is_kriged || components->view_variance_threshold > 0;
    return map_views(components, of->node, are_weighed ? of->variance : NULL, error);
}

/* What a view says of a node of its map counts for less the less its images tell of it: beyond them the map is but
 * continued, and other views may know better. */
static float trust(float variance, float view_variance_threshold)
{
    float ratio = 1 + variance / view_variance_threshold;
    return 1 / (ratio * ratio);
}

/* Room for one light node. */
typedef struct node_bench {
    float *weight, *value, *solved; /* [view], [view][layer][3], [view node][layer][3] */
} node_bench;

static weft_code smooth_views(const view_maps *of, size_t light, const node_bench *bench, weft_error *error)
{
    const weft_components *components = of->components;
    size_t lights = light_nodes(components);
    for (size_t view = 0; view < (size_t)components->view_count; view++)
        bench->weight[view] = components->view_variance_threshold > 0
                                  ? trust(of->variance[view * lights + light], components->view_variance_threshold)
                                  : 1;
    weft_smooth_map *map = NULL;
    WEFT_TRY(weft_smooth_map_create(&(weft_smooth_map_places){.side = components->view_side,
                                                              .smoothness = components->view_smoothness,
                                                              .place = of->place,
                                                              .weight = bench->weight,
                                                              .count = components->view_count},
                                    &map, error));
    weft_code code = weft_smooth_map_solve(map, bench->value, 3 * components->component_count, bench->solved, error);
    weft_smooth_map_free(map);
    return code;
}

/* What the map of a view leaves unknown at a node is noise of its value there. */
static weft_code krige_views(const view_maps *of, size_t light, const node_bench *bench, weft_error *error)
{
    const weft_components *components = of->components;
    size_t lights = light_nodes(components);
    for (size_t view = 0; view < (size_t)components->view_count; view++)
        bench->weight[view] = of->variance[view * lights + light];
    weft_kriged_map *map = NULL;
    WEFT_TRY(weft_kriged_map_create(&(weft_kriged_places){.grid = &of->grid,
                                                          .place = of->place,
                                                          .noise = bench->weight,
                                                          .count = components->view_count,
                                                          .nugget = components->view_nugget,
                                                          .ordinary = true},
                                    &map, error));
    weft_code code = weft_kriged_map_solve(map, bench->value, 3 * components->component_count, bench->solved, error);
    weft_kriged_map_free(map);
    return code;
}

/* One light node: what the views say of it becomes a map over the views. */
static weft_code solve_light_node(const view_maps *of, size_t light, const node_bench *bench, float *node,
                                  weft_error *error)
{
    const weft_components *components = of->components;
    size_t series = 3 * (size_t)components->component_count, lights = light_nodes(components);
    size_t nodes = (size_t)components->view_side * (size_t)components->view_side;
    for (size_t view = 0; view < (size_t)components->view_count; view++)
        memcpy(bench->value + view * series, of->node + (view * lights + light) * series,
               series * sizeof *bench->value);
    WEFT_TRY(weft_components_are_kriged(components->kind) ? krige_views(of, light, bench, error)
                                                          : smooth_views(of, light, bench, error));
    for (size_t i = 0; i < nodes; i++)
        memcpy(node + (i * lights + light) * series, bench->solved + i * series, series * sizeof *node);
    return WEFT_OK;
}

static weft_code map_light_node(const view_maps *of, int light, float *node, weft_error *error)
{
    const weft_components *components = of->components;
    size_t series = 3 * (size_t)components->component_count, views = (size_t)components->view_count;
    size_t nodes = (size_t)components->view_side * (size_t)components->view_side;
    node_bench bench = {.weight = malloc(views * sizeof *bench.weight),
                        .value = malloc(views * series * sizeof *bench.value),
                        .solved = malloc(nodes * series * sizeof *bench.solved)};
    weft_code code = bench.weight && bench.value && bench.solved
                         ? solve_light_node(of, (size_t)light, &bench, node, error)
                         : weft_fail_memory(error, "maps of components", nodes * series * sizeof *bench.solved);
    free(bench.weight);
    free(bench.value);
    free(bench.solved);
    return code;
}

/* node [view node][light node][layer][3]. */
static weft_code map_over_views(const view_maps *of, float *node, weft_error *error)
{
    weft_code result = WEFT_OK;
    int lights = (int)light_nodes(of->components);
#pragma omp parallel for schedule(dynamic)
    for (int light = 0; light < lights; light++) {
        weft_error own = {0};
        weft_code code = map_light_node(of, light, node, &own);
#pragma omp critical(weft_component_maps)
        if (code != WEFT_OK && result == WEFT_OK) {
            result = code;
            if (error)
                *error = own;
        }
    }
    return result;
}

weft_code weft_component_maps_create(const weft_components *components, weft_component_maps *maps, weft_error *error)
{
    size_t nodes = (size_t)components->view_side * (size_t)components->view_side;
    size_t bytes = nodes * light_nodes(components) * 3 * (size_t)components->component_count * sizeof *maps->node;
    view_maps of;
    *maps = (weft_component_maps){.components = components, .node = malloc(bytes)};
    weft_code code = make_view_maps(components, &of, error);
    if (code == WEFT_OK && !maps->node)
        code = weft_fail_memory(error, "maps of components", bytes);
    if (code == WEFT_OK)
        code = map_over_views(&of, maps->node, error);
    free_view_maps(&of);
    if (code != WEFT_OK)
        weft_component_maps_free(maps);
    return code;
}

weft_code weft_component_maps_keep_views(weft_component_maps *maps, weft_error *error)
{
    const weft_components *components = maps->components;
    size_t row = light_nodes(components) * 3 * (size_t)components->component_count;
    size_t bytes = (size_t)components->view_count * row * sizeof *maps->node_of_view;
    maps->node_of_view = malloc(bytes);
    return maps->node_of_view ? map_views(components, maps->node_of_view, NULL, error)
                              : weft_fail_memory(error, "maps of components", bytes);
}

void weft_component_maps_free(weft_component_maps *maps)
{
    free(maps->node);
    free(maps->node_of_view);
    *maps = (weft_component_maps){0};
}
