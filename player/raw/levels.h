/* Rows of all images, from the finest level down to 1 x 1: a row of blocks goes on as soon as its texels are there. */
#ifndef WEFT_PLAYER_RAW_LEVELS_H
#define WEFT_PLAYER_RAW_LEVELS_H

#include "player/raw/plan.h"

/* A row of blocks of a level in one column of tiles, image by image as weft_raw_store has them. */
typedef struct weft_raw_strip {
    int part, level, column, row; /* level 0: the finest that is held */
    size_t bytes;
    void *texels;
} weft_raw_strip;

/* Takes the texels of a strip, also where it fails. */
typedef weft_code weft_raw_take(void *context, const weft_raw_strip *strip, weft_error *error);

typedef struct weft_raw_levels weft_raw_levels;

/* For one part of the plan; the finest level of the dataset has this size. `plan` is kept. Errors: WEFT_SYSTEM. The
 * caller frees with weft_raw_levels_free. */
weft_code weft_raw_levels_create(const weft_raw_plan *plan, int part, int width, int height, weft_raw_take *take,
                                 void *context, weft_raw_levels **result, weft_error *error);
void weft_raw_levels_free(weft_raw_levels *levels);

/* Where row y of the finest level is to be written: [width][channels][image], 3 channels of samples, 1 of opacity. */
float *weft_raw_levels_row(weft_raw_levels *levels, int y);

/* Row y of the finest level is written; rows come in their order. Levels are box means of samples. Errors: those of
 * `take`, WEFT_SYSTEM. */
weft_code weft_raw_levels_push(weft_raw_levels *levels, int y, weft_error *error);

#endif
