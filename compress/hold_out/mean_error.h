/* Errors of what is held out, and their means over splits. */
#ifndef WEFT_COMPRESS_HOLD_OUT_MEAN_ERROR_H
#define WEFT_COMPRESS_HOLD_OUT_MEAN_ERROR_H

#include "compress/hold_out/hold_out.h"
#include "compress/hold_out/trial.h"

/* How many splits are in each mean. */
typedef struct weft_means_taken {
    int all, view, light, both;
} weft_means_taken;

/* The errors of one split. Errors: WEFT_SYSTEM for memory. */
weft_code weft_hold_out_summarise(const weft_asked_samples *compared, weft_hold_out_error *result, weft_error *error);

/* Takes one more summary into a mean over `*taken` of them; one without values does not count. */
void weft_summary_take(const weft_error_summary *one, int *taken, weft_error_summary *mean);

/* The same of all summaries. */
void weft_hold_out_take(const weft_hold_out_error *one, weft_means_taken *taken, weft_hold_out_error *mean);

#endif
