/* What a picture shows instead of radiance on request: the mip level, and where nothing was measured. Linear RGB. Pure
 * functions, thread safe. GLSL twins: player/draw/shaders/shade.frag.glsl, which takes the colours from here. */
#ifndef WEFT_PLAYER_SCENE_FALSE_COLOUR_H
#define WEFT_PLAYER_SCENE_FALSE_COLOUR_H

#include <stdbool.h>
#include <stdint.h>

enum { WEFT_LEVEL_COLOURS = 6, WEFT_EXTRAPOLATION_TINTS = 3 };

extern const float weft_level_palette[WEFT_LEVEL_COLOURS][3]; /* of levels 0 to 5; the last of all above */
/* Of the view, of the light, of the place or its level; they add up. */
extern const float weft_extrapolation_tint[WEFT_EXTRAPOLATION_TINTS][3];

/* The colour of the level, linear between two, times 1/4 + 3/4 of the mean of `value`. */
void weft_level_shown(const float value[3], float level, float shown[3]);

/* What of a pixel the material does not have. */
typedef struct weft_missing {
    bool view, light; /* beyond the last measured ring, or where the scene that it was pruned for has none */
    bool place;       /* a texel, or a mip level, that this scene does not reach */
} weft_missing;

/* Tinted where something is missing, whatever colour the cloth has; else `value`. */
void weft_extrapolation_shown(const float value[3], weft_missing missing, float shown[3]);

/* The same on grey cloth of a middle brightness (1/2 in sRGB), 0xRRGGBBAA of sRGB. */
uint32_t weft_level_swatch(int level);
uint32_t weft_extrapolation_swatch(weft_missing missing);

#endif
