/* Texels of several mip levels as texels of one excerpt: the means of samples that a material's coarser levels are
 * fitted to. */
#ifndef WEFT_COMPRESS_HOLD_OUT_EXCERPT_LEVELS_H
#define WEFT_COMPRESS_HOLD_OUT_EXCERPT_LEVELS_H

#include "compress/hold_out/excerpt.h"

enum {
    WEFT_EXCERPT_LAST_LEVEL = 3,  /* of 8 x 8 texels: more would be read than is fitted */
    WEFT_EXCERPT_LEVEL_SIDE = 8,  /* along each side, so many texels of a coarser level at most */
    WEFT_EXCERPT_NO_LEVEL = 0xff, /* of a texel that fills up the last row */
};

/* Reads single texels, at most side x side, and then as many as 8 x 8 of each of levels 1, 2 and 3, where there are
 * four or more: each at another place of its cell of a grid over the whole. The first rows are the single texels; with
 * `side` 0 there are none. level [height][width] receives the level of each texel. A texel of a coarser level has the
 * means of those of the samples under it that are not masked. For far lights. The caller frees the excerpt and *level,
 * also on failure. Errors: those of reading; WEFT_SYSTEM. */
weft_code weft_excerpt_read_levels(weft_dataset *dataset, int side, weft_excerpt *excerpt, uint8_t **level,
                                   weft_error *error);

#endif
