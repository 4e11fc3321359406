/* How far predictions p are from samples s. */
#ifndef WEFT_STUDY_ERROR_PREDICTION_ERROR_H
#define WEFT_STUDY_ERROR_PREDICTION_ERROR_H

#include "base/status.h"

#include <stdint.h>

typedef struct weft_prediction_error {
    long count;                   /* sample values (channels counted one by one) */
    double relative_rmse;         /* sqrt(mean (p - s)^2 / mean s^2) */
    double median_relative;       /* median of |p - s| / max(s, floor), floor = 1e-4 of the largest sample */
    double percentile80_relative; /* its 80th percentile */
    double rmse;                  /* sqrt(mean (p - s)^2) */
} weft_prediction_error;

/* One value of one channel, and where it was seen and lit from. */
typedef struct weft_prediction {
    float prediction, sample;
    uint8_t view_ring, light_ring;
} weft_prediction;

/* Which predictions to look at. */
typedef struct weft_prediction_choice {
    enum { WEFT_CHOOSE_ALL, WEFT_CHOOSE_VIEW_RING, WEFT_CHOOSE_LIGHT_RING } by;
    int ring;
} weft_prediction_choice;

/* The error over the chosen ones among value [count]; the floor comes from all of them. No value gives zeros.
 * Errors: WEFT_SYSTEM for memory. */
weft_code weft_prediction_error_of(const weft_prediction *value, long count, weft_prediction_choice choice,
                                   weft_prediction_error *result, weft_error *error);

#endif
