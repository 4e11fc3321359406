/* Analytic cloth on the GPU: weaves (shader: player/draw/shaders/analytic.glsl) and microcylinder threads
 * (threads.glsl). Threads have no place on the cloth: their model is a mean over them. */
#ifndef WEFT_PLAYER_TEXTURE_WEAVE_TEXTURE_H
#define WEFT_PLAYER_TEXTURE_WEAVE_TEXTURE_H

#include "player/gl/gl.h"
#include "player/texture/weave_texels.h"
#include "reflectance/microcylinder/microcylinder.h"

#include <stddef.h>

/* Where a sample covers less than half a cell the woven texture is evaluated, where it covers more than two the mean of
 * the tile, in between a blend by the logarithm of the footprint. Intensity noise fades likewise, by the size of its
 * own cells. Begins zeroed. */
typedef struct weft_weave_texture {
    GLuint table, means, noisy_means; /* noisy_means: 0 where it is the same */
    bool has_noise, has_staples, has_filaments;
    int texels;
    weft_weave_layout layout;
} weft_weave_texture;

/* Takes the place of what `texture` had, which stays on failure. `layout` is that on one material, with which it
 * repeats.
 * Errors: WEFT_BAD_USAGE for a number of tiles that is not positive, WEFT_SYSTEM. The caller frees with
 * weft_weave_texture_free. */
weft_code weft_weave_texture_upload(const weft_weave_texels *texels, const weft_weave_layout *layout,
                                    weft_weave_texture *texture, weft_error *error);
void weft_weave_texture_free(weft_weave_texture *texture);

/* Of graphics memory. */
size_t weft_weave_texture_bytes(const weft_weave_texture *texture);

/* Sets the uniforms of analytic.glsl; `program` is in use. noise_seed 0: without noise. */
void weft_weave_texture_bind(const weft_weave_texture *texture, GLuint program, unsigned noise_seed);

typedef struct weft_thread_texture {
    GLuint table; /* 0: none */
} weft_thread_texture;

/* Takes the place of what `texture` (zeroed at first) had, which stays on failure. Errors: WEFT_SYSTEM. The caller
 * frees with weft_thread_texture_free. */
weft_code weft_thread_texture_upload(const weft_microcylinder_cloth *cloth, weft_thread_texture *texture,
                                     weft_error *error);
void weft_thread_texture_free(weft_thread_texture *texture);

/* Of graphics memory. */
size_t weft_thread_texture_bytes(const weft_thread_texture *texture);

/* Sets the uniforms of threads.glsl; `program` is in use. */
void weft_thread_texture_bind(const weft_thread_texture *texture, GLuint program);

#endif
