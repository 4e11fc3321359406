/* The heights of a dataset on their way to the graphics card. */
#ifndef WEFT_PLAYER_RAW_RELIEF_H
#define WEFT_PLAYER_RAW_RELIEF_H

#include "btf/dataset/dataset.h"
#include "player/raw/fill.h"
#include "player/texture/relief_map.h"

/* What `dataset` holds, for those of its views that have usable images; a plane is one height for all. A dataset of
 * near lights has none. Errors: those of weft_dataset_read_heights; WEFT_SYSTEM. The caller frees with
 * weft_relief_map_free. */
weft_code weft_raw_relief_make(weft_dataset *dataset, const weft_raw_images *images, weft_relief_map *relief,
                               weft_error *error);

#endif
