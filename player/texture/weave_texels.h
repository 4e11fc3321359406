/* What the graphics card needs to know of a weave, computed without it, in any thread. */
#ifndef WEFT_PLAYER_TEXTURE_WEAVE_TEXELS_H
#define WEFT_PLAYER_TEXTURE_WEAVE_TEXELS_H

#include "btf/direction/direction.h"
#include "reflectance/weave/weave.h"

typedef struct weft_weave_texels {
    int width, height;
    float (*table)[4]; /* [height * width], as weft_weave_table has it */
    float (*mean)[4];  /* [view][light] of ubo81: the mean of the tile, BRDF in 1/sr, within 1e-3 of its highlights */
    float (*noisy_mean)[4];      /* the same with inclination noise, NULL where there is none */
    bool has_noise;              /* of either kind */
    int tile_width, tile_height; /* cells */
} weft_weave_texels;

/* Some milliseconds for most weaves. Errors: WEFT_SYSTEM for memory. The caller frees with weft_weave_texels_free, also
 * on failure. */
weft_code weft_weave_texels_of(const weft_weave *weave, weft_weave_texels *texels, weft_error *error);
void weft_weave_texels_free(weft_weave_texels *texels);

#endif
