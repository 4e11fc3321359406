/* What a list of measurements says. All are 0 for an empty list. */
#ifndef WEFT_BENCH_FIT_STATISTICS_H
#define WEFT_BENCH_FIT_STATISTICS_H

/* Processor time of this thread, which other programs on the machine do not lengthen. */
double thread_microseconds(void);

double mean_of(const double *values, int count);

/* The relative RMSE (base/numeric/error_summary.h) with this residual where the samples have this energy. */
double relative_rmse(double residual, double energy);

/* Share of the values at or below `limit`. */
double share_at_most(const double *values, int count, double limit);

#endif
