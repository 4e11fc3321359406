/* A dataset on the GPU, sample for sample (shader: player/draw/shaders/raw.glsl). */
#ifndef WEFT_PLAYER_RAW_TEXTURE_H
#define WEFT_PLAYER_RAW_TEXTURE_H

#include "player/raw/stream.h"
#include "player/texture/direction_map.h"
#include "player/texture/relief_map.h"

#include <stdbool.h>
#include <stddef.h>

/* The textures hold BRDF x pi of each image, and opacity of each view: tiles with their mip levels (box means), each of
 * whose rows and columns ends with its first texel again, so that the hardware's bilinear filter wraps round. Samples
 * that the mask rules out are filled as in raw_fill.h; images and views without a valid sample are left out of the
 * triangulations. */
typedef struct weft_raw_texture {
    weft_raw_plan plan;
    GLuint part[WEFT_RAW_PARTS];
    weft_direction_texture directions; /* set 0: views; the label of a view is the set of its lights */
    weft_relief_texture relief;
    bool opaque; /* no texel has an opacity below 1 */
} weft_raw_texture;

/* Of the current context; half floats up to 512 MiB, 1000 MiB at all. */
weft_raw_limits weft_raw_texture_limits(weft_raw_format format);

/* What the sink of weft_raw_stream calls: makes the textures, then fills them strip by strip. `opaque` is the caller's
 * to set at the end. Errors: WEFT_SYSTEM. The caller frees with weft_raw_texture_free, also on failure. */
weft_code weft_raw_texture_begin(const weft_raw_plan *plan, const weft_direction_map *directions,
                                 const weft_relief_map *relief, weft_raw_texture *texture, weft_error *error);
weft_code weft_raw_texture_put(const weft_raw_texture *texture, const weft_raw_strip *strip, weft_error *error);

/* The whole dataset at once. Errors: those of weft_raw_stream. The caller frees with weft_raw_texture_free, also on
 * failure. */
weft_code weft_raw_texture_upload(weft_dataset *dataset, const weft_raw_limits *limits, const weft_progress *progress,
                                  weft_raw_texture *texture, weft_error *error);
void weft_raw_texture_free(weft_raw_texture *texture);

/* Of graphics memory, without the directions. */
size_t weft_raw_texture_bytes(const weft_raw_texture *texture);

/* Sets the uniforms of raw.glsl; `program` is in use. */
void weft_raw_texture_bind(const weft_raw_texture *texture, GLuint program);

#endif
