/* Which photographs of a dataset can be compared across views: those of the lights that its views share. Private to the
 * room. */
#ifndef WEFT_RELIEF_VIEWS_H
#define WEFT_RELIEF_VIEWS_H

#include "btf/dataset/dataset.h"

enum { WEFT_MOST_LIGHTS = 128 };

typedef struct weft_relief_views {
    int view_count, light_count;
    int *number;          /* [view_count] of the view in the dataset */
    weft_vec3 *direction; /* [view_count] */
    int *image;           /* [view_count][light_count] the lights in the same order for every view */
    float *cosine;        /* [light_count] what turns a sample into reflectance times cosine */
} weft_relief_views;

/* Takes the lights of the view that has most images (128 of them at most, evenly), and the views that have an image
 * within five degrees of each. `path` names the dataset. Errors: WEFT_BAD_INPUT for near lights and views, and where
 * fewer than eight views share their lights; WEFT_SYSTEM. The caller frees with weft_relief_views_free. */
weft_code weft_relief_views_find(const weft_dataset_layout *layout, const char *path, weft_relief_views *views,
                                 weft_error *error);
void weft_relief_views_free(weft_relief_views *views);

#endif
