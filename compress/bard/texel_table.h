/* BARD in one texel: its table from the samples under the light along the normal, and its samples under all others.
 * Private to the room. */
#ifndef WEFT_COMPRESS_BARD_TEXEL_TABLE_H
#define WEFT_COMPRESS_BARD_TEXEL_TABLE_H

#include "compress/bard/table_photographs.h"

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
