/* Aliasing energy: the mean squared difference, in linear light, between a picture drawn with one sample a pixel and
 * the same view of the finest level drawn with many, over the pixels whose neighbours all lie on the mesh too (so that
 * silhouettes, which no mip level can help, do not count). */
#ifndef WEFT_TESTS_PLAYER_ALIASING_H
#define WEFT_TESTS_PLAYER_ALIASING_H

#include "player/draw/player.h"

typedef struct aliasing {
    weft_image without, with, reference; /* level 0, mip levels by footprint, samples x samples of level 0 */
    double energy_without, energy_with;
    long pixels;
} aliasing;

/* Measures the compressed mode of a scene. Errors: those of drawing. The caller frees with aliasing_free. */
weft_code aliasing_measure(weft_player *player, weft_scene scene, int width, int height, int samples, aliasing *result,
                           weft_error *error);
void aliasing_free(aliasing *result);

/* The drape seen from afar in a picture of this height: a pixel covers 3 to 4 texels of a material of 32 across. */
weft_scene aliasing_scene(int height);

#endif
