/* The number of components that an error or the size of a file asks for. */
#ifndef WEFT_COMPARE_TRADEOFF_COMPONENT_COUNT_H
#define WEFT_COMPARE_TRADEOFF_COMPONENT_COUNT_H

#include "compress/compress.h"
#include "compress/hold_out/hold_out.h"

typedef struct weft_component_count {
    int count;
    bool is_met;            /* the wish; else no number of components meets it, and this one comes nearest */
    weft_hold_out held_out; /* for an error: what was measured with so many; else without splits */
    double bytes;           /* for a size: of the file, predicted from some texels; else 0 */
} weft_component_count;

/* The fewest components, a multiple of 4 up to WEFT_COMPONENTS_MAX, whose relative RMSE on directions that were not
 * fitted is at most `wished`, as weft_hold_out_measure measures it with so many splits. Doubles the number until it
 * suffices, then halves the step back: half a dozen measurements. Where none suffices, the number with the least error
 * of those tried. Errors: those of weft_hold_out_measure. */
weft_code weft_components_for_error(weft_dataset *dataset, const weft_compress_options *options, double wished,
                                    int split_count, const char *scratch_path, const weft_progress *progress,
                                    weft_component_count *result, weft_error *error);

/* The most components whose file is predicted to have at most `bytes` (compare/tradeoff/prediction.h); 4 where not even
 * these do. Errors: those of weft_prediction_find_costs. */
weft_code weft_components_for_size(weft_dataset *dataset, const weft_compress_options *options, uint64_t bytes,
                                   const char *scratch_path, const weft_progress *progress,
                                   weft_component_count *result, weft_error *error);

#endif
