/* The maps of what a scene reaches of a material on the GPU (shader: player/draw/shaders/shade.frag.glsl). */
#ifndef WEFT_PLAYER_TEXTURE_SEEN_TEXTURE_H
#define WEFT_PLAYER_TEXTURE_SEEN_TEXTURE_H

#include "btf/material/visibility.h"
#include "player/gl/gl.h"

typedef struct weft_visibility_texture {
    GLuint maps; /* 0: there are none */
    int finer_levels, coarser_levels, level_count;
} weft_visibility_texture;

/* `seen` may be NULL. Errors: WEFT_SYSTEM. The caller frees with weft_visibility_texture_free, also on failure. */
weft_code weft_visibility_texture_upload(const weft_material_visibility *visibility, weft_visibility_texture *texture,
                                         weft_error *error);
void weft_visibility_texture_free(weft_visibility_texture *texture);

/* Binds to `unit`. */
void weft_visibility_texture_bind(const weft_visibility_texture *texture, GLuint program, int unit);

#endif
