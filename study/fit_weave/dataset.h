/* A weave fitted to a dataset: to the mean of its tile where it repeats. */
#ifndef WEFT_STUDY_FIT_WEAVE_DATASET_H
#define WEFT_STUDY_FIT_WEAVE_DATASET_H

#include "study/fit_weave/fit_weave.h"
#include "study/tile/tile.h"

typedef struct weft_fit_weave_source {
    bool tiled;                        /* the mean is that of a tile */
    weft_tile_report tile;             /* their size, and where one begins */
    int tiles_x, tiles_y;              /* so many whole ones lie in the material */
    char why_whole[WEFT_MESSAGE_SIZE]; /* why the mean is that of the whole material, or "" */
} weft_fit_weave_source;

/* Finds the tile of the weave in the dataset (weft_tile_find), averages it over the material but for a sixteenth at
 * each edge, every place of the tile alike, and fits the weave to that mean BRDF (weft_fit_weave). Where no tile is
 * found, or none is whole, the mean is that of the whole material. The weave then lies (weave->layout) as the tiles do,
 * or anyhow. Errors: those of reading and of weft_fit_weave. */
weft_code weft_fit_weave_to_dataset(weft_dataset *dataset, weft_weave *weave, const weft_progress *progress,
                                    weft_fit_weave_source *source, weft_fit_weave_report *report, weft_error *error);

#endif
