#include "player/texture/relief_map.h"

#include <math.h>
#include <stdlib.h>

static weft_code allocate(weft_relief_map *map, weft_error *error)
{
    size_t places = (size_t)map->width * (size_t)map->height, views = (size_t)map->view_count;
    map->share = malloc(places * sizeof *map->share);
    map->seen = malloc(places * views);
    map->slope = malloc(2 * views * sizeof *map->slope);
    return map->share && map->seen && map->slope ? WEFT_OK : weft_fail_memory(error, "heights", places * views);
}

static void fill(const weft_height_field *field, const weft_vec3 *view, weft_relief_map *map)
{
    size_t places = (size_t)field->width * (size_t)field->height;
    float range = field->high - field->low, scale = range > 0 ? 65535 / range : 0;
    for (size_t i = 0; i < places; i++)
        map->share[i] = (uint16_t)lroundf((field->value[i] - field->low) * scale);
#pragma omp parallel for schedule(dynamic)
    for (int v = 0; v < map->view_count; v++) {
        weft_real slope[2];
        weft_relief_slope(field, view[v], slope);
        map->slope[2 * v] = (float)slope[0];
        map->slope[2 * v + 1] = (float)slope[1];
        weft_relief_see(field, view[v], map->seen + (size_t)v * places);
    }
}

weft_code weft_relief_map_make(const weft_height_field *field, const weft_vec3 *view, int view_count, int level_count,
                               weft_relief_map *map, weft_error *error)
{
    *map = (weft_relief_map){.width = field->width,
                             .height = field->height,
                             .view_count = view_count,
                             .level_count = level_count,
                             .range_mm = {(double)field->low, (double)field->high},
                             .size_mm = {field->width_mm, field->height_mm}};
    weft_code code = allocate(map, error);
    if (code == WEFT_OK)
        fill(field, view, map);
    else
        weft_relief_map_free(map);
    return code;
}

void weft_relief_map_free(weft_relief_map *map)
{
    free(map->share);
    free(map->seen);
    free(map->slope);
    *map = (weft_relief_map){0};
}
