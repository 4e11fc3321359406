/* Spherical triangulations laid out for a shader: barycentric lookup by walking (GLSL twin:
 * player/draw/shaders/directions.glsl).
 *
 * Every triangle and every border arc of every set is a simplex: three corners and where to go when a query lies beyond
 * one of its sides. A hemisphere laid flat (octahedral map) gives the simplex to start from. */
#ifndef WEFT_PLAYER_TEXTURE_DIRECTION_MAP_H
#define WEFT_PLAYER_TEXTURE_DIRECTION_MAP_H

#include "base/status.h"
#include "btf/direction/triangulation.h"
#include "player/gl/gl.h"

#include <stdint.h>

enum {
    WEFT_DIRECTION_GRID = 64,         /* cells along each side of the map of a set */
    WEFT_DIRECTION_SETS_PER_ROW = 64, /* maps side by side in the texture */
    WEFT_DIRECTION_SIMPLICES_PER_ROW = 256
};

/* As it is uploaded. form: for each corner, the linear form of a query whose value is the corner's weight up to a
 * common factor, and the label of the corner. The query lies in the simplex where none is negative; next: where to go
 * from each that is, -1: nowhere. The third form of an arc is negative where the query lies in the triangle that the
 * arc bounds; it is no weight, and its label is -1. */
typedef struct weft_simplex {
    float form[3][4];
    float next[3];
    float padding;
} weft_simplex;

typedef struct weft_direction_map {
    int interleave_count, simplex_count, simplex_capacity;
    weft_simplex *simplex;
    int32_t (*cell)[WEFT_DIRECTION_GRID * WEFT_DIRECTION_GRID]; /* [interleave_count] simplex to start from */
} weft_direction_map;

/* Adds the triangulation of `count` directions as set number map->interleave_count (before the call). label[i] is what
 * the shader gets for direction i (NULL: i). Start from a zeroed map; the caller frees it with weft_direction_map_free,
 * also on failure. Errors: WEFT_BAD_INPUT for what cannot be triangulated, WEFT_SYSTEM. */
weft_code weft_direction_map_add(weft_direction_map *map, const weft_vec3 *direction, const int *label, int count,
                                 weft_error *error);
void weft_direction_map_free(weft_direction_map *map);

typedef struct weft_direction_texture {
    GLuint simplex, cell;
} weft_direction_texture;

/* Errors: WEFT_SYSTEM. The caller frees with weft_direction_texture_free, also on failure. */
weft_code weft_direction_texture_upload(const weft_direction_map *map, weft_direction_texture *texture,
                                        weft_error *error);
void weft_direction_texture_free(weft_direction_texture *texture);

/* Binds to units `unit` and `unit` + 1. */
void weft_direction_texture_bind(const weft_direction_texture *texture, GLuint program, int unit);

#endif
