/* Cloth of microcylinder threads on the GPU (shader: player/draw/shaders/threads.glsl). It has no place on the cloth:
 * the model is a mean over its threads. */
#ifndef WEFT_PLAYER_TEXTURE_THREAD_TEXTURE_H
#define WEFT_PLAYER_TEXTURE_THREAD_TEXTURE_H

#include "player/gl/gl.h"
#include "reflectance/microcylinder/microcylinder.h"

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
