/* The error of a material split into what each stage from the cloth to the file added to it.
 *
 * Five values answer every query, a place, a light and a view drawn at random: t, the cloth itself; s, what its exact
 * samples in the measured directions say, interpolated; r, the samples that registration made of photographs of these
 * directions, interpolated alike; m, the material that was fitted to those; f, the same as its file says it. With
 * E = sum t^2 over queries and channels the squared relative error of a stage is
 *
 *     e(x) = sum (x - t)^2 / E
 *
 * and the parts are what it grew by from one stage to the next:
 *
 *     directions e(s),  registration e(r) - e(s),  model e(m) - e(r),  storage e(f) - e(m)
 *
 * They add up to e(f), the square of the relative RMSE (base/numeric/error_summary.h), by construction. They are no
 * independent errors. A part is the square of what its stage changed, and twice the product of that with the error that
 * was there before,
 *
 *     e(r) - e(s) = sum (r - s)^2 / E + 2 sum (r - s)(s - t) / E
 *
 * so that it is negative where a stage makes up for an error before it, as a smooth model does that is fitted to noise.
 * What its stage changed alone is `own`.
 *
 * t and s may come from random paths of light. Both are given twice, each time from paths of its own, and squares are
 * products of the two: the noise drops out of the mean without being known. So an error that is small beside its noise
 * may come out below 0. */
#ifndef WEFT_COMPARE_ERROR_BUDGET_STACK_H
#define WEFT_COMPARE_ERROR_BUDGET_STACK_H

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

typedef enum weft_error_source {
    WEFT_SOURCE_DIRECTIONS,
    WEFT_SOURCE_REGISTRATION, /* the photographs, too: lens, sensor, lamp */
    WEFT_SOURCE_MODEL,
    WEFT_SOURCE_STORAGE,
    WEFT_SOURCES
} weft_error_source;

/* "directions", "registration", "model", "storage". Pure. */
const char *weft_error_source_name(weft_error_source source);

/* The answers to a query, reflectance times cosine by channel. */
typedef struct weft_source_answer {
    double cloth[2][3], sampled[2][3]; /* t and s, twice */
    double registered[3], fitted[3], stored[3];
} weft_source_answer;

/* With the ends of an interval of 95 %. */
typedef struct weft_source_share {
    double value, low, high;
} weft_source_share;

typedef struct weft_error_stack {
    size_t query_count;
    weft_source_share part[WEFT_SOURCES], whole; /* squared relative errors */
    double own[WEFT_SOURCES];                    /* what each stage changed, squared, in the same unit */
    double noise; /* standard error of the cloth's mean of its two answers, RMS, relative to the RMS of the cloth */
} weft_error_stack;

/* Intervals are the percentiles of 1000 draws of as many queries with replacement (the bootstrap of Efron 1979): they
 * hold for other queries of the same photographs, not for other photographs. `seed` decides the draws. Errors:
 * WEFT_BAD_USAGE without a query or where the cloth is black; WEFT_SYSTEM for memory. */
weft_code weft_error_stack_of(const weft_source_answer *answer, size_t count, uint64_t seed, weft_error_stack *stack,
                              weft_error *error);

#endif
