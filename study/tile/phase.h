/* Where the tile of a weave begins in a material that looks like it. Private to study/. */
#ifndef WEFT_STUDY_TILE_PHASE_H
#define WEFT_STUDY_TILE_PHASE_H

#include "study/tile/pictures.h"
#include "study/tile/tile.h"

/* Takes the shortest repeat in the report for a fraction of the tile of the weave, 1 to 3 along each axis, renders that
 * tile under the lights and views of the pictures, and correlates it with theirs. Sets the tile and likeness. Errors:
 * WEFT_BAD_INPUT where the likeness stays below 0.3; WEFT_SYSTEM. */
weft_code weft_tile_phase_find(const weft_tile_pictures *pictures, const weft_dataset_layout *layout, const char *path,
                               const weft_weave *weave, weft_tile_report *report, weft_error *error);

#endif
