/* The models that fit every texel alone, streamed through the dataset block by block. */
#ifndef WEFT_COMPRESS_RUN_DENSE_H
#define WEFT_COMPRESS_RUN_DENSE_H

#include "base/progress.h"
#include "compress/run/checkpoint.h"
#include "compress/run/memory.h"
#include "compress/texel/texel.h"

/* How to go about it; no part of it changes a bit of the result. */
typedef struct weft_dense_job {
    weft_memory_budget budget;
    const char *checkpoint_path;       /* NULL: none */
    weft_checkpoint_identity identity; /* of the dataset and of all options that change the result */
    weft_log log;
    const weft_progress *progress;
} weft_dense_job;

typedef struct weft_dense_result {
    weft_texel_counts counts;
    long masked;
    weft_checkpoint *checkpoint; /* still open, for what follows to go on with; the caller closes it. NULL: none */
} weft_dense_result;

/* Fits and measures all levels of `material`, whose shape and views are set. A block of 2^k x 2^k texels is read once,
 * the next one while it is fitted; the sums of its groups give the levels up to k, and are handed on to the levels
 * above. Errors: those of reading; WEFT_BAD_USAGE where not even blocks of one texel fit into the budget; those of
 * weft_checkpoint_open and weft_checkpoint_append; WEFT_SYSTEM for memory. */
weft_code weft_dense_fit(weft_dataset *dataset, const weft_texel_source *source, const weft_dense_job *job,
                         weft_material *material, weft_dense_result *result, weft_error *error);

#endif
