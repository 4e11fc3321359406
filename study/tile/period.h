/* The shortest repeat of a material along both axes. Private to study/. */
#ifndef WEFT_STUDY_TILE_PERIOD_H
#define WEFT_STUDY_TILE_PERIOD_H

#include "study/tile/pictures.h"
#include "study/tile/tile.h"

/* Sets width, height, repeat_x and repeat_y of the report. `path` names the dataset in messages. Errors: WEFT_BAD_INPUT
 * where the pictures do not repeat at least about twice along both axes; WEFT_SYSTEM. */
weft_code weft_tile_period_find(const weft_tile_pictures *pictures, const char *path, weft_tile_report *report,
                                weft_error *error);

/* Width and height, known to about a texel over the whole material, where a Fourier series of the tile, down to waves
 * of three texels, explains most of the pictures. Errors: WEFT_SYSTEM. */
weft_code weft_tile_period_refine(const weft_tile_pictures *pictures, weft_tile *tile, weft_error *error);

#endif
