/* A dataset on the GPU, sample for sample (shader: player/shaders/raw.glsl). */
#ifndef WEFT_PLAYER_RAW_TEXTURE_H
#define WEFT_PLAYER_RAW_TEXTURE_H

#include "btf/dataset.h"
#include "btf/progress.h"
#include "player/direction_texture.h"
#include "player/mip_layout.h"

#include <stdbool.h>
#include <stddef.h>

/* The texture holds BRDF x pi. Each image is a tile with its mip levels (box means of the samples), each with a border
 * of one texel that repeats the opposite side, so that the hardware's bilinear filter wraps round. Samples that the
 * mask rules out are filled from the nearest valid light of the same view; images and views without a valid sample are
 * left out of the triangulations. Alpha is the opacity of the texel in that view. */
typedef struct weft_raw_texture {
    GLuint sample;
    weft_direction_texture directions; /* set 0: views; the label of a view is the set of its lights */
    weft_mip_layout layout;            /* of the levels that are held */
    int skipped_levels;                /* finest levels left out because they do not fit */
    bool packed;                       /* RGB with a shared exponent: 4 bytes a sample instead of 8, without opacity */
    bool opaque;                       /* no texel has an opacity below 1 */
    int columns, layers;
} weft_raw_texture;

/* Bytes of graphics memory up to which samples are kept as half floats, and up to which at all. */
#define WEFT_RAW_HALF_LIMIT ((size_t)512 << 20)
#define WEFT_RAW_LIMIT ((size_t)1000 << 20)

/* Streams the dataset into a texture of at most `limit` bytes (half floats up to `half_limit`); where it does not fit,
 * the finest levels are left out. Memory stays at a few rows of the dataset. A dataset of near lights uses the
 * directions of its centre. Errors: those of reading; WEFT_BAD_INPUT where no sample is valid or nothing fits;
 * WEFT_SYSTEM. The caller frees with weft_raw_texture_free, also on failure. */
weft_code weft_raw_texture_upload(weft_dataset *dataset, size_t half_limit, size_t limit, const weft_progress *progress,
                                  weft_raw_texture *texture, weft_error *error);
void weft_raw_texture_free(weft_raw_texture *texture);

/* Of graphics memory, without the directions. */
size_t weft_raw_texture_bytes(const weft_raw_texture *texture);

/* Sets the uniforms of raw.glsl; `program` is in use. */
void weft_raw_texture_bind(const weft_raw_texture *texture, GLuint program);

#endif
