/* Heights on the GPU (shader: reflectance/relief/relief.glsl). */
#ifndef WEFT_PLAYER_TEXTURE_RELIEF_TEXTURE_H
#define WEFT_PLAYER_TEXTURE_RELIEF_TEXTURE_H

#include "player/gl/gl.h"
#include "player/texture/relief_map.h"

#include <stddef.h>

typedef struct weft_relief_texture {
    GLuint height, seen, slope; /* 0: there are no heights */
    double range_mm[2], size_mm[2];
    int level_count;
    size_t bytes; /* of graphics memory */
} weft_relief_texture;

/* Errors: WEFT_SYSTEM. The caller frees with weft_relief_texture_free, also on failure. */
weft_code weft_relief_texture_upload(const weft_relief_map *map, weft_relief_texture *texture, weft_error *error);
void weft_relief_texture_free(weft_relief_texture *texture);

/* Sets the uniforms of relief.glsl, from texture unit `unit` on (three of them); does nothing without heights.
 * `program` is in use. */
void weft_relief_texture_bind(const weft_relief_texture *texture, GLuint program, int unit);

#endif
