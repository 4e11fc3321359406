/* The steps of the search for a tile: its size, the size more exactly, and where it begins. Private to the room. */
#ifndef WEFT_EDIT_TILE_SEARCH_STEPS_H
#define WEFT_EDIT_TILE_SEARCH_STEPS_H

#include "edit/tile/textured_pictures.h"
#include "edit/tile/tile.h"

/* Sets width, height, repeat_x and repeat_y of the report. `path` names the dataset in messages. Errors: WEFT_BAD_INPUT
 * where the pictures do not repeat at least about twice along both axes; WEFT_SYSTEM. */
weft_code weft_tile_period_find(const weft_tile_pictures *pictures, const char *path, weft_tile_report *report,
                                weft_error *error);

/* Width and height, known to about a texel over the whole material, where a Fourier series of the tile, down to waves
 * of three texels, explains most of the pictures. Errors: WEFT_SYSTEM. */
weft_code weft_tile_period_refine(const weft_tile_pictures *pictures, weft_tile *tile, weft_error *error);

/* Takes the shortest repeat in the report for a fraction of the tile of the weave, 1 to 3 along each axis, renders that
 * tile under the lights and views of the pictures, and correlates it with theirs. Sets the tile and likeness. Errors:
 * WEFT_BAD_INPUT where the likeness stays below 0.3; WEFT_SYSTEM. */
weft_code weft_tile_phase_find(const weft_tile_pictures *pictures, const weft_dataset_layout *layout, const char *path,
                               const weft_weave *weave, weft_tile_report *report, weft_error *error);

/* Where `function` is largest within [low, high], to `tolerance`, if it has one peak there: by golden section (Kiefer
 * 1953). */
double weft_golden_section(double (*function)(void *context, double x), void *context, double low, double high,
                           double tolerance);

#endif
