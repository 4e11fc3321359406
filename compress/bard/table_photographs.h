/* Which photographs of a dataset make the table of BARD, and what every image takes from them. Private to the room. */
#ifndef WEFT_COMPRESS_BARD_TABLE_PHOTOGRAPHS_H
#define WEFT_COMPRESS_BARD_TABLE_PHOTOGRAPHS_H

#include "btf/dataset/dataset.h"
#include "reflectance/bard/bard.h"

#include <stdbool.h>

/* Immutable once made; freed with weft_bard_plan_free. */
typedef struct weft_bard_plan {
    int count;                               /* photographs under the light along the normal, one a view */
    int *photograph;                         /* [count] image of an entry of the table */
    weft_vec3 *view;                         /* [count] view of an entry */
    double least_tilt_deg, largest_tilt_deg; /* of the lights nearest the normal; the second of those that are used */
    bool *is_used;                           /* [image_count] whether an image is one of them */
    weft_bard_mix *mix; /* [image_count] what an image takes from the table; a photograph that is used takes itself */
} weft_bard_plan;

/* Images with left_out[image] != 0 are not taken (NULL: all are). Errors: WEFT_BAD_INPUT with messages that start with
 * `path`: near lights, no light near the normal, too few views under it; WEFT_SYSTEM for memory. */
weft_code weft_bard_plan_create(const weft_dataset_layout *layout, const uint8_t *left_out, const char *path,
                                weft_bard_map map, weft_bard_plan *plan, weft_error *error);
void weft_bard_plan_free(weft_bard_plan *plan);

#endif
