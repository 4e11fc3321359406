/* A dataset that is read in the background and shown once all of it is on the graphics card; what was shown before
 * stays until then. */
#ifndef WEFT_PLAYER_SETTINGS_DATASET_LOAD_H
#define WEFT_PLAYER_SETTINGS_DATASET_LOAD_H

#include "player/draw/player.h"
#include "player/raw/plan.h"
#include "player/settings/loader.h"

typedef struct weft_dataset_load weft_dataset_load;

/* The samples are to be kept in this format. Needs the player's context, as do show and free. Errors: WEFT_SYSTEM. The
 * caller frees with weft_dataset_load_free, once the load is released. */
weft_code weft_dataset_load_create(weft_player *player, weft_raw_format format, weft_dataset_load **result,
                                   weft_error *error);
void weft_dataset_load_free(weft_dataset_load *load);

/* In the background: reads all of `dataset`, row by row, and needs it no longer. Errors: those of weft_raw_stream and
 * weft_load_post. */
weft_code weft_dataset_load_read(weft_dataset_load *load, weft_dataset *dataset, weft_load *background,
                                 weft_error *error);

/* After reading: the player shows it. *plan receives how it is kept. */
void weft_dataset_load_show(weft_dataset_load *load, weft_raw_plan *plan);

#endif
