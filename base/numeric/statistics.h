/* Quantiles of values.
 *
 * There is one rule for the rank. Of n values in ascending order, x[0] to x[n - 1], the quantile of the share q is
 *
 *     x[round(q (n - 1))]
 *
 * where a half is rounded up. So a quantile is always one of the values, the share 0 gives the smallest and the share 1
 * the largest, and the median of an even number of values is the upper of the two in the middle. A value that is not a
 * number counts as larger than every number. */
#ifndef WEFT_BASE_NUMERIC_STATISTICS_H
#define WEFT_BASE_NUMERIC_STATISTICS_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The quantile of `share` (0 to 1) of value [count], which it reorders; 0 where there is no value. Takes time in
 * proportion to the count. Thread-safe for different arrays. */
double weft_quantile(double *value, size_t count, double share);

/* The same of floats. */
float weft_quantile_of_floats(float *value, size_t count, double share);

#ifdef __cplusplus
}
#endif
#endif
