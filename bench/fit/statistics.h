/* What a list of measurements says. All are 0 for an empty list. */
#ifndef WEFT_BENCH_FIT_STATISTICS_H
#define WEFT_BENCH_FIT_STATISTICS_H

/* Processor time of this thread, which other programs on the machine do not lengthen. */
double thread_microseconds(void);

double mean_of(const double *values, int count);

/* Root of a residual over the energy of the samples; 0 where those are black. */
double relative_rmse(double residual, double energy);

/* Linear between the neighbours in order; NaN counts as the largest. `share` 0.5 is the median. Errors: NaN where
 * memory is short. */
double quantile_of(const double *values, int count, double share);

/* Share of the values at or below `limit`. */
double share_at_most(const double *values, int count, double limit);

#endif
