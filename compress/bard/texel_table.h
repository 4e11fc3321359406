/* BARD in one texel: its table from the samples under the light along the normal, and its samples under all others.
 * Private to the room. */
#ifndef WEFT_COMPRESS_BARD_TEXEL_TABLE_H
#define WEFT_COMPRESS_BARD_TEXEL_TABLE_H

#include "btf/dataset/dataset.h"
#include "reflectance/bard/bard.h"

#include <stdbool.h>

/* ---- Table photographs ---- */

/* Which photographs of a dataset make the table of BARD, and what every image takes from them. Private to the room. */

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

/* The table of a texel. Owned by one thread, used for one texel after the other. */
typedef struct weft_bard_texel {
    float (*specular)[3]; /* [plan count] BRDF x pi under light along the normal, less the diffuse albedo */
    bool *is_valid;       /* [plan count] */
    float diffuse[3];     /* albedo */
    int filled_count;     /* entries taken from the nearest valid view; -1 where no entry is valid */
} weft_bard_texel;

/* Errors: WEFT_SYSTEM for memory. */
weft_code weft_bard_texel_create(const weft_bard_plan *plan, weft_bard_texel *texel, weft_error *error);
void weft_bard_texel_free(weft_bard_texel *texel);

/* Fills the table from samples [image_count][3] and mask [image_count] of a texel. */
void weft_bard_texel_measure(const weft_bard_plan *plan, const weft_dataset_layout *layout, double diffuse_share,
                             const weft_half *samples, const uint8_t *mask, weft_bard_texel *texel);

/* What the texel shows in every image: samples [image_count][3] as the dataset holds values, and mask [image_count]
 * (0, or WEFT_MASK_MISSING where the table is empty). */
void weft_bard_texel_predict(const weft_bard_plan *plan, const weft_dataset_layout *layout,
                             const weft_bard_texel *texel, weft_half *samples, uint8_t *mask);

#endif
