/* `weft compress` measures its error on directions that were not fitted, before the work. */
#ifndef WEFT_CLI_COMPRESS_HELD_OUT_H
#define WEFT_CLI_COMPRESS_HELD_OUT_H

#include "cli/command/arguments.h"
#include "compress/compress.h"
#include "compress/hold_out/hold_out.h"

enum { WEFT_ENOUGH_SPLITS = -1 };

typedef struct weft_held_out_job {
    const weft_common_options *common;
    const char *scratch_path;
    int split_count; /* 0: nothing is measured; WEFT_ENOUGH_SPLITS: as many as the dataset asks for */
    const weft_progress *progress;
} weft_held_out_job;

/* How many splits the job measures of a dataset. Errors: those of weft_hold_out_enough_splits. */
weft_code weft_held_out_splits(const weft_held_out_job *job, const weft_dataset *dataset, int *count,
                               weft_error *error);

/* Where it cannot be measured, for want of memory say, or because the texels that were chosen are holes, the user is
 * told, and `result` has no splits: what concerns the whole, too, its fit will say. Errors: those of
 * weft_hold_out_measure but WEFT_BAD_USAGE and WEFT_BAD_INPUT. */
weft_code weft_measure_held_out(const weft_held_out_job *job, weft_dataset *dataset,
                                const weft_compress_options *options, weft_hold_out *result, weft_error *error);

/* Components of which more than half is wrong where they were not fitted, as of a cloth that shines back in a beam
 * narrower than the photographs are apart: then the same directions are asked of one lobe, too, and the user is told
 * where it leaves clearly less. Nobody asked for it: where it fails nothing is said. */
void weft_suggest_lobes(const weft_held_out_job *job, weft_dataset *dataset, const weft_compress_options *options,
                        const weft_hold_out *of_components);

#endif
