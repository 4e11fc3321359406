/* What the graphics card needs to know of a weave, computed without it, in any thread. */
#ifndef WEFT_PLAYER_TEXTURE_WEAVE_TEXELS_H
#define WEFT_PLAYER_TEXTURE_WEAVE_TEXELS_H

#include "reflectance/weave/shader_table.h"

typedef struct weft_weave_texels {
    int width, height;
    float (*table)[4];                   /* [height * width], as weft_weave_table has it */
    weft_weave_means means, noisy_means; /* noisy_means: with inclination noise, without texels where there is none */
    bool has_noise;                      /* of either kind */
    int tile_width, tile_height;         /* cells */
} weft_weave_texels;

/* Errors: WEFT_SYSTEM for memory. The caller frees with weft_weave_texels_free, also on failure. */
weft_code weft_weave_texels_of(const weft_weave *weave, weft_weave_texels *texels, weft_error *error);
void weft_weave_texels_free(weft_weave_texels *texels);

#endif
