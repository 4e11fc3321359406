/* Spherical triangulations laid out for a shader: barycentric lookup by walking (GLSL twin:
 * player/shaders/directions.glsl).
 *
 * Every triangle and every border arc of every set is a simplex: three corners and where to go when a query lies beyond
 * one of its sides. A hemisphere laid flat (octahedral map) gives the simplex to start from. */
#ifndef WEFT_PLAYER_DIRECTION_MAP_H
#define WEFT_PLAYER_DIRECTION_MAP_H

#include "btf/status.h"
#include "btf/triangulation.h"

#include <stdint.h>

enum {
    WEFT_DIRECTION_GRID = 32,         /* cells along each side of the map of a set */
    WEFT_DIRECTION_SETS_PER_ROW = 64, /* maps side by side in the texture */
    WEFT_DIRECTION_SIMPLICES_PER_ROW = 256
};

/* As it is uploaded. corner: a unit direction and the label of its entry. next: the simplex across the side opposite to
 * each corner of a triangle; of an arc, the next arcs beyond its first and second corner and the triangle it bounds.
 * -1: none. An arc repeats its second corner; a single direction repeats its first three times. */
typedef struct weft_simplex {
    float corner[3][4];
    float next[3];
    float is_arc; /* 1 or 0 */
} weft_simplex;

typedef struct weft_direction_map {
    int set_count, simplex_count, simplex_capacity;
    weft_simplex *simplex;
    int32_t (*cell)[WEFT_DIRECTION_GRID * WEFT_DIRECTION_GRID]; /* [set_count] simplex to start from */
} weft_direction_map;

/* Adds the triangulation of `count` directions as set number map->set_count (before the call). label[i] is what the
 * shader gets for direction i (NULL: i). Start from a zeroed map; the caller frees it with weft_direction_map_free,
 * also on failure. Errors: WEFT_BAD_INPUT for what cannot be triangulated, WEFT_SYSTEM. */
weft_code weft_direction_map_add(weft_direction_map *map, const weft_vec3 *direction, const int *label, int count,
                                 weft_error *error);
void weft_direction_map_free(weft_direction_map *map);

#endif
