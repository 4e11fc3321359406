/* The error of a material on directions that it was never fitted to. */
#ifndef WEFT_STUDY_HOLD_OUT_HOLD_OUT_H
#define WEFT_STUDY_HOLD_OUT_HOLD_OUT_H

#include "base/numeric/error_summary.h"
#include "base/progress.h"
#include "btf/material/certificate.h"
#include "compress/compress.h"
#include "study/hold_out/split.h"

/* Means over the splits of their errors (base/numeric/error_summary.h); counts are sums. Zero where a split holds out
 * none of the kind. */
typedef struct weft_hold_out_error {
    weft_error_summary all;               /* of all images that were held out */
    weft_error_summary view, light, both; /* of those whose view alone, whose light alone, and both of whose were */
} weft_hold_out_error;

/* Heights are played where their error is at most this part of that without. */
#define WEFT_HOLD_OUT_HEIGHTS_GAIN 0.95

/* Whether layers are to be seen through the heights of the dataset: relative RMSE over all samples of what was held out
 * that can be predicted through them, means over the splits. */
typedef struct weft_hold_out_heights {
    bool asked, used;
    double with, without;
} weft_hold_out_heights;

typedef struct weft_hold_out {
    weft_split_kind kind;
    int split_count;
    int view_count, view_held_count, light_count, light_held_count; /* as in weft_splits */
    int image_count, image_held_count;                              /* held of a split, the mean rounded */
    long texel_count, dataset_texel_count;                          /* measured, and all */
    bool smaller_model; /* the images that were left carry less than all of them do */
    weft_hold_out_heights heights;
    weft_hold_out_error material;    /* as it is to be played: through heights where they are used */
    weft_hold_out_error photographs; /* interpolated between those that were not held out, as raw is played: through
                                        the surface of the dataset where it has one */
    double photographs_flat;         /* relative RMSE of the same samples without it; 0 where there is none */
    weft_error_summary fitted;       /* of the same fits where they were fitted: on what the next split holds out, which
                                        lies in the same rings. Zero where there is no next one */
    bool has_certificate;            /* not where all that is predicted is black */
    weft_certificate certificate;    /* an interval for any pixel, at 0.95 */
} weft_hold_out;

/* Fits some texels with `options` to the images that a split leaves, for each of up to `split_count` splits, and
 * compares what the material says of the others with their samples, in the quantity of the dataset. Without mip levels,
 * held-out images of `options` and checkpoint. A budget is taken for the share of the texels in the whole material.
 * Which texels are measured says study/hold_out/measured_texels.h: at most 16 x 16 single ones (24 x 24 with layers),
 * and for the coarser levels of the certificate 8 x 8 of each of levels 1 to 3, all of them spread; small squares where
 * options->memory_bytes is a limit; 64 x 64 neighbours where the fit borrows from them or the dataset has a surface,
 * which is seen in other texels than its own. Layers are asked with and without it, and what is better counts. What was
 * left out is not in what the fit reads: neither its samples, nor its views as entries of T.
 *
 * Writes a dataset of those texels to the folder of `scratch_path`, nameless once it is complete. The result does
 * not depend on the number of threads, nor on how large the limit is.
 * Errors: WEFT_BAD_USAGE for a dataset of one image, where all that was held out is masked, or as weft_compress; those
 * of reading; WEFT_SYSTEM. */
weft_code weft_hold_out_measure(weft_dataset *dataset, const weft_compress_options *options, int split_count,
                                const char *scratch_path, const weft_progress *progress, weft_hold_out *result,
                                weft_error *error);

#endif
