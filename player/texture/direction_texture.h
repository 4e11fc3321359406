/* A direction map on the GPU. */
#ifndef WEFT_PLAYER_TEXTURE_DIRECTION_TEXTURE_H
#define WEFT_PLAYER_TEXTURE_DIRECTION_TEXTURE_H

#include "player/gl/gl.h"
#include "player/texture/direction_map.h"

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
