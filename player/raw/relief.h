/* The heights of a dataset on their way to the graphics card (shader: reflectance/relief/relief.glsl). */
#ifndef WEFT_PLAYER_RAW_RELIEF_H
#define WEFT_PLAYER_RAW_RELIEF_H

#include "btf/dataset/dataset.h"
#include "player/raw/fill.h"

typedef struct weft_raw_relief {
    int width, height, view_count; /* width 0: the dataset has neither heights nor a plane */
    int level_count;               /* the finest levels on which they count */
    double range_mm[2], size_mm[2];
    uint16_t *share; /* [height][width] of 65535: the height within the range */
    uint8_t *seen;   /* [view_count][height][width] */
    float *slope;    /* [view_count][2] */
} weft_raw_relief;

/* What `dataset` holds, for those of its views that have usable images; a plane is one height for all. A dataset of
 * near lights has none. Errors: those of weft_dataset_read_heights; WEFT_SYSTEM. The caller frees with
 * weft_raw_relief_free. */
weft_code weft_raw_relief_make(weft_dataset *dataset, const weft_raw_images *images, weft_raw_relief *relief,
                               weft_error *error);
void weft_raw_relief_free(weft_raw_relief *relief);

#endif
