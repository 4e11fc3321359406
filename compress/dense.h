/* The models that fit every texel alone, streamed through the dataset in square tiles. */
#ifndef WEFT_COMPRESS_DENSE_H
#define WEFT_COMPRESS_DENSE_H

#include "btf/progress.h"
#include "compress/texel.h"

/* Fits and measures all levels of `material`, whose shape and views are set. A tile of 2^k x 2^k texels is read once;
 * the means of its groups give the levels up to k, and one group per tile is kept for the levels above. Errors: those
 * of reading, WEFT_SYSTEM for memory. */
weft_code weft_dense_fit(weft_dataset *dataset, const weft_texel_source *source, const weft_progress *progress,
                         weft_material *material, weft_texel_counts *counts, long *masked_count, weft_error *error);

#endif
