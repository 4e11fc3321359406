/* How far predictions are from samples: the one measure of error in Weft.
 *
 * Over n values with samples s_i and predictions p_i (channels are values of their own):
 *
 *     RMSE                   = sqrt(sum (p_i - s_i)^2 / n)
 *     relative RMSE          = sqrt(sum (p_i - s_i)^2 / sum s_i^2)
 *     median relative error  = the median of |p_i - s_i| / s_i over the values that are not dim
 *     80th percentile        = the quantile of 0.8 of the same
 *     PSNR                   = 20 log10(peak / RMSE) dB, peak = the quantile of 0.999 of the samples above 0
 *
 * A value is dim where its sample is at most 1e-4 of the largest sample, so every sample that is not above 0 is dim. A
 * dim sample is mostly noise, and its relative error says nothing: it is left out of the median and of the percentile
 * (no other number takes its place). It counts in the two RMSEs, which it hardly changes. The rule for the rank of a
 * quantile is that of base/numeric/statistics.h. Without values all numbers are 0. The median and the percentile are 0
 * where all values are dim. The PSNR is infinite where the prediction is perfect (JSON, which has no infinity, says 0),
 * and 0 where no sample is above 0.
 *
 * docs/reference/error-measures.md says the same to users. */
#ifndef WEFT_BASE_NUMERIC_ERROR_SUMMARY_H
#define WEFT_BASE_NUMERIC_ERROR_SUMMARY_H

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

/* The median and the percentile are fractions: 0.05 is 5 %. */
typedef struct weft_error_summary {
    double median_relative, percentile80_relative;
    double rmse; /* in the unit of the samples */
    double relative_rmse;
    double psnr_db;
    long count; /* values that were compared; 0 in a material read from a file, which does not hold it */
} weft_error_summary;

/* The largest sample times this is the largest dim one. */
static const double weft_dim_share = 1e-4;

/* The quantile of the samples that is the peak of a PSNR. */
static const double weft_peak_share = 0.999;

/* ---- Sums ---- */

/* Sums over values: their number, s^2 and (p - s)^2. Added in a fixed order they have the same bits every time. */
typedef struct weft_error_sums {
    double count, square, square_error;
} weft_error_sums;

/* Adds one value to the sums. */
static inline void weft_error_sums_add_value(weft_error_sums *sums, double sample, double prediction)
{
    sums->count += 1;
    sums->square += sample * sample;
    sums->square_error += (prediction - sample) * (prediction - sample);
}

/* Adds the sums of other values. */
void weft_error_sums_add(weft_error_sums *sums, const weft_error_sums *other);

/* The relative RMSE; 0 where all samples are black. Pure. */
double weft_error_sums_relative_rmse(const weft_error_sums *sums);

/* ---- Summaries ---- */

/* The summary with these sums, quantiles (the relative errors of 0.5 and 0.8) and peak, however they were found. Pure.
 */
weft_error_summary weft_error_summary_make(const weft_error_sums *sums, double median_relative,
                                           double percentile80_relative, double peak);

/* A sample and what is predicted for it. */
typedef struct weft_compared {
    float sample, prediction;
} weft_compared;

/* Summarises value [count]. Thread-safe. Errors: WEFT_SYSTEM for memory. */
weft_code weft_error_summary_of(const weft_compared *value, size_t count, weft_error_summary *result,
                                weft_error *error);

/* Summarises those of value [count] whose entry in group [count] is `chosen`. All values, not only the chosen ones, say
 * which sample is the largest. Thread-safe. Errors: WEFT_SYSTEM for memory. */
weft_code weft_error_summary_of_group(const weft_compared *value, const uint8_t *group, size_t count, int chosen,
                                      weft_error_summary *result, weft_error *error);

#endif
