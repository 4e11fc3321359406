/* Kriging: what a covariance (compress/kriging/covariance.h) says of the reflectance of a texel under directions that
 * nobody photographed, given its samples.
 *
 *     r(x) = sum_i cov(x, x_i) a_i,   (C + N) a = y,   C_ij = cov(x_i, x_j),   N_ii = noise / weight_i
 *
 * Of all predictions that are linear in the samples y it has the least expected square error. Texels with the same
 * directions share C, and its factorisation. */
#ifndef WEFT_COMPRESS_KRIGING_KRIGING_H
#define WEFT_COMPRESS_KRIGING_KRIGING_H

#include "base/status.h"
#include "compress/kriging/covariance.h"

/* Places of samples. Neither is owned. */
typedef struct weft_kriging_places {
    int count;
    const weft_direction_pair *pair; /* [count] */
    const double *weight;            /* [count] > 0, what a squared error counts for; 1 in the mean */
} weft_kriging_places;

typedef struct weft_kriging {
    int count;
    double *root; /* [count][count] Cholesky's factor L of C + N, column by column */
} weft_kriging;

/* The caller frees. Errors: WEFT_BAD_INPUT for places that are no numbers; WEFT_SYSTEM. */
weft_code weft_kriging_create(const weft_covariance *covariance, const weft_kriging_places *places,
                              weft_kriging *kriging, weft_error *error);
void weft_kriging_free(weft_kriging *kriging);

/* Replaces samples [series_count][count] by their weights a. Thread-safe. */
void weft_kriging_solve(const weft_kriging *kriging, double *sample, int series_count);

/* Replaces the root by the inverse of C + N, both triangles: no solving afterwards. */
void weft_kriging_invert(weft_kriging *kriging);

/* cov(x, x_i) for all i. Thread-safe. */
void weft_kriging_row(const weft_covariance_terms *terms, const weft_kriging_places *places,
                      const weft_direction_pair *at, float *row);

#endif
