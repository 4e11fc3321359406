/* Repeats of a sequence, from its autocorrelation: along [count] for lag 0, 1, .., 1 at lag 0 if it is normalised. */
#ifndef WEFT_BASE_NUMERIC_REPEAT_H
#define WEFT_BASE_NUMERIC_REPEAT_H

#include <stdbool.h>

/* A correlation below this is no repeat. Noise alone stays far below it where every lag is a mean over many pairs. */
#define WEFT_LEAST_REPEAT 0.2

/* Whether lag (1 to count - 2) has the highest value among its neighbours. Pure. */
static inline bool weft_repeat_is_peak(const double *along, int lag)
{
    return along[lag] >= along[lag - 1] && along[lag] > along[lag + 1];
}

/* The vertex of the parabola through a peak and its neighbours, as a lag. Pure. */
double weft_repeat_vertex(const double *along, int lag);

/* The lag of the first repeat, or 0: the first peak, beyond the first minimum, of WEFT_LEAST_REPEAT at least and of 85
 * % of the highest at least. The others are its multiples. It is at most 0.55 of the count: two repeats, or nearly,
 * must fit. Pure. */
int weft_repeat_first(const double *along, int count);

#endif
