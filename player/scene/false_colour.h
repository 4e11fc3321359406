/* What a picture shows instead of radiance on request: the mip level, and where nothing was measured. Linear RGB. Pure
 * functions, thread safe. GLSL twins: player/draw/shaders/shade.frag.glsl, which takes the colours from here. */
#ifndef WEFT_PLAYER_SCENE_FALSE_COLOUR_H
#define WEFT_PLAYER_SCENE_FALSE_COLOUR_H

#include <stdbool.h>
#include <stdint.h>

enum { WEFT_LEVEL_COLOURS = 6 };

extern const float weft_level_palette[WEFT_LEVEL_COLOURS][3]; /* of levels 0 to 5; the last of all above */
extern const float weft_extrapolation_tint[2][3];             /* of the view, of the light; they add up */

/* The colour of the level, linear between two, times 1/4 + 3/4 of the mean of `value`. */
void weft_level_shown(const float value[3], float level, float shown[3]);

/* Tinted where the view or the light lies beyond the last measured ring, whatever colour the cloth has; else `value`.
 */
void weft_extrapolation_shown(const float value[3], bool view, bool light, float shown[3]);

/* The same on grey cloth of a middle brightness (1/2 in sRGB), 0xRRGGBBAA of sRGB. */
uint32_t weft_level_swatch(int level);
uint32_t weft_extrapolation_swatch(bool view, bool light);

#endif
