/* What a fit leaves besides the material: errors by texel and by level, and counts. It goes block by block into a
 * checkpoint and comes back from it together with the texels themselves. */
#ifndef WEFT_COMPRESS_RUN_FITTED_H
#define WEFT_COMPRESS_RUN_FITTED_H

#include "compress/run/block_reader.h"
#include "compress/run/checkpoint.h"
#include "compress/texel/texel.h"

/* Sums are kept by texel and added up at the end in the order of the texels, so that neither threads nor blocks leave a
 * trace in the last bits; histograms and counts add up exactly in any order. */
typedef struct weft_fitted {
    weft_material *material;                                 /* not owned */
    weft_error_sums *sums[WEFT_MATERIAL_MAX_LEVELS];         /* [height][width] of the level */
    weft_error_tally *tally[WEFT_MATERIAL_MAX_LEVELS];       /* of all blocks before the present one */
    weft_error_tally *block_tally[WEFT_MATERIAL_MAX_LEVELS]; /* of the present one */
    weft_texel_counts counts, block_counts;                  /* their sums are not used */
    long masked, block_masked;
} weft_fitted;

/* Errors: WEFT_SYSTEM. */
weft_code weft_fitted_create(weft_material *material, weft_fitted *fitted, weft_error *error);
void weft_fitted_free(weft_fitted *fitted);

/* Saves the texels of a block, levels 0 to `finished`, with its errors and counts, or loads them (record->loading). */
void weft_fitted_transfer_block(weft_fitted *fitted, const weft_block_place *block, int finished, weft_record *record);

/* Adds all but the sums of errors. */
void weft_fitted_add_counts(weft_texel_counts *to, const weft_texel_counts *from);

/* Adds the errors and counts of the present block to those before. */
void weft_fitted_end_block(weft_fitted *fitted);

/* Sets the errors of all levels of the material. */
void weft_fitted_finish(const weft_fitted *fitted);

#endif
