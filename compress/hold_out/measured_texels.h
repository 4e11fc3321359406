/* The texels by which a material is measured on directions that were held out: which, how many, and where from. */
#ifndef WEFT_COMPRESS_HOLD_OUT_MEASURED_TEXELS_H
#define WEFT_COMPRESS_HOLD_OUT_MEASURED_TEXELS_H

#include "compress/hold_out/split.h"
#include "compress/hold_out/texel_subset.h"
#include "compress/options/options.h"

/* Freed with weft_measured_texels_free. */
typedef struct weft_measured_texels {
    weft_texel_subset subset;
    weft_texel_block asked;  /* of the subset: the texels that are asked for; of width 0: all */
    weft_texel_subset alone; /* these, where they are fitted alone; else nothing */
    uint8_t *level;          /* [texel] of the subset, where they are of several levels; else NULL */
    int neighbours; /* texels beside each other lie in squares, or are means of squares, so many along a side */
    double spacing; /* of these squares, in their texels (compress/hold_out/certify.h) */
} weft_measured_texels;
void weft_measured_texels_free(weft_measured_texels *texels);

/* What is fitted: the texels that are asked for, or with them what they are seen through. Pure. */
const weft_texel_subset *weft_measured_texels_fitted(const weft_measured_texels *texels);

/* How many are asked for. Pure. */
long weft_measured_texels_count(const weft_measured_texels *texels);

/* Whether single texels and those of coarser levels are measured that lie spread, and not squares of neighbours. What
 * glints is rare, and neighbours glint together, so that a few squares of them may say twice as much as all texels
 * would. Where memory is short the squares serve: spread texels lie in many chunks of the file, which take more of it.
 * Near lights, fits that borrow from neighbours and a surface need texels of their own. Pure. */
bool weft_measures_spread_texels(const weft_dataset *dataset, const weft_compress_options *options,
                                 const weft_splits *splits);

/* How many single texels are read along each side, of at least as many. Pure. */
int weft_measured_texels_spread_side(const weft_dataset_layout *layout, const weft_compress_options *options);

/* Reads single texels, each at another place of its cell of a grid. The caller frees. Errors: those of reading. */
weft_code weft_measured_texels_read_spread(weft_dataset *dataset, const weft_compress_options *options,
                                           weft_measured_texels *texels, weft_error *error);

/* Reads texels of levels 1 to 3, each at another place of its cell of a grid: what a material is fitted to there.
 * Components are fitted with the single texels beside them, from which a material's components are learned. The caller
 * frees, also on failure. Errors: those of reading. */
weft_code weft_measured_texels_read_levels(weft_dataset *dataset, const weft_compress_options *options,
                                           weft_measured_texels *texels, weft_error *error);

/* Reads neighbours: small squares that lie spread, or a block where neighbours are fitted together or seen through a
 * surface; under near lights single texels at even distances. The caller frees. Errors: those of reading;
 * WEFT_BAD_USAGE where options->memory_bytes does not suffice. */
weft_code weft_measured_texels_read(weft_dataset *dataset, const weft_compress_options *options,
                                    const weft_splits *splits, weft_measured_texels *texels, weft_error *error);

/* Along each side of the block of texels that is read of a dataset with a surface: 64, or fewer of very many images.
 * What a view saw beyond the block is not known, and steep views see furthest: of a part of a material less counts what
 * they see. Pure. */
int weft_hold_out_surface_side(int image_count);

#endif
