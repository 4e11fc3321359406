/* The summary of errors (base/numeric/error_summary.h) of a material over very many samples in bounded memory: sums in
 * order, quantiles by histogram. */
#ifndef WEFT_COMPRESS_FIT_ERROR_TALLY_H
#define WEFT_COMPRESS_FIT_ERROR_TALLY_H

#include "base/numeric/error_summary.h"
#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Counts of samples by magnitude and by relative error; owned by the caller. Counting commutes, so that tallies of
 * threads may be merged in any order. */
typedef struct weft_error_tally weft_error_tally;

weft_code weft_error_tally_create(weft_error_tally **result, weft_error *error);
void weft_error_tally_free(weft_error_tally *tally);

/* Counts one sample and what the material makes of it. */
void weft_error_tally_add(weft_error_tally *tally, float sample, float prediction);

/* Adds all counts of `other` and clears them. */
void weft_error_tally_merge(weft_error_tally *tally, weft_error_tally *other);

/* The counts that are not 0, for keeping them in a file: entry [n][2] is a bin and its count. Returns n; `entry` may be
 * NULL to learn it first. */
size_t weft_error_tally_entries(const weft_error_tally *tally, uint32_t (*entry)[2]);

/* Adds such counts. False, with some of them added, where a bin does not exist. */
bool weft_error_tally_add_entries(weft_error_tally *tally, uint32_t (*entry)[2], size_t count);

/* The summary of the values in the tally and in the sums. Its quantiles are linear inside a bin of a histogram and so
 * accurate to 2 % of their value; the limit below which a sample is dim is accurate to half an octave. Pure. */
weft_error_summary weft_error_tally_summarise(const weft_error_tally *tally, const weft_error_sums *sums);

#endif
