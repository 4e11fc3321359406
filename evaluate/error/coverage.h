/* Whether the intervals of a certificate hold what they promise: how many samples lie in theirs. */
#ifndef WEFT_EVALUATE_ERROR_COVERAGE_H
#define WEFT_EVALUATE_ERROR_COVERAGE_H

#include "base/numeric/error_summary.h"
#include "btf/direction/direction.h"

/* Over `count` values; the means are 0 without any. */
typedef struct weft_coverage_share {
    long count;
    double covered; /* share of the samples that lie in their interval */
    double width;   /* mean, of the part above 0, in units of the mean sample */
} weft_coverage_share;

typedef struct weft_coverage {
    weft_coverage_share all, by_view[WEFT_RING_COUNT], by_light[WEFT_RING_COUNT];
    weft_coverage_share dark, bright; /* of the smallest fifth of the predictions, and of the largest */
    double even_width; /* what the mean width would be if all intervals were alike and as many samples lay in them: the
                          naive interval, chosen afterwards on these very samples */
} weft_coverage;

/* A sample with its prediction, half the width of the interval about that, and its rings. */
typedef struct weft_covered {
    weft_compared value;
    float half_width;
    uint8_t view, light;
} weft_covered;

/* Counts covered [count]. Errors: WEFT_SYSTEM for memory. */
weft_code weft_coverage_of(const weft_covered *covered, size_t count, weft_coverage *result, weft_error *error);

#endif
