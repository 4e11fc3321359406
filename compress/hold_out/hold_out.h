/* The error of a material on directions that it was never fitted to. */
#ifndef WEFT_COMPRESS_HOLD_OUT_HOLD_OUT_H
#define WEFT_COMPRESS_HOLD_OUT_HOLD_OUT_H

#include "base/progress.h"
#include "btf/material/held_out.h"
#include "compress/compress.h"
#include "compress/hold_out/split.h"

/* Heights are played where their error is at most this part of that without. */
#define WEFT_HOLD_OUT_HEIGHTS_GAIN 0.95

/* Fits some texels with `options` to the images that a split leaves, for each of up to `split_count` splits, and
 * compares what the material says of the others with their samples, in the quantity of the dataset. Without mip levels,
 * held-out images of `options` and checkpoint.
 * Which texels are measured says compress/hold_out/measured_texels.h: at most 16 x 16 single ones (24 x 24 with
 * components), and for the coarser levels of the certificate 8 x 8 of each of levels 1 to 3, all of them spread; small
 * squares where options->memory_bytes is a limit; 64 x 64 neighbours where the fit borrows from them or the dataset has
 * a surface, which is seen in other texels than its own. Components are asked with and without it, and what is better
 * counts. What was left out is not in what the fit reads: neither its samples, nor its views as entries of T.
 *
 * Writes a dataset of those texels to the folder of `scratch_path`, nameless once it is complete. The result does
 * not depend on the number of threads, nor on how large the limit is.
 * Errors: WEFT_BAD_USAGE for a dataset of one image, where all that was tried or held out is masked, or as
 * weft_compress; those of reading; WEFT_SYSTEM. */
weft_code weft_hold_out_measure(weft_dataset *dataset, const weft_compress_options *options, int split_count,
                                const char *scratch_path, const weft_progress *progress, weft_hold_out *result,
                                weft_error *error);

#endif
