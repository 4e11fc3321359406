/* Kriging: what a covariance (compress/kriging/covariance.h) says of the reflectance of a texel under directions that
 * nobody photographed, given its samples.
 *
 *     r(x) = sum_i cov(x, x_i) a_i,   (C + N) a = y,   C_ij = cov(x_i, x_j),   N_ii = noise / weight_i
 *
 * Of all predictions that are linear in the samples y it has the least expected square error. Texels with the same
 * directions share C, and its factorisation. */
#ifndef WEFT_COMPRESS_KRIGING_KRIGING_H
#define WEFT_COMPRESS_KRIGING_KRIGING_H

#include "base/progress.h"
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

/* ---- The choice of the covariance ---- */

/* Samples of texels that have the same directions. Not owned. */
typedef struct weft_kriging_samples {
    weft_kriging_places places;
    int series_count;     /* texels times channels */
    const double *sample; /* [series_count][places.count] */
} weft_kriging_samples;

/* Fewer images than this decide nothing: the covariance is that of a diffuse term. */
enum { WEFT_KRIGING_LEAST_IMAGES = 4 };

/* Fewer do not decide by which powers highlights grow: what a wrong power says near the horizon is worse than what the
 * usual one does. */
enum { WEFT_KRIGING_LEAST_FOR_POWERS = 20 };

/* Chooses the numbers of the covariance one after another, the steps of their logarithms growing smaller, so that the
 * squared error of all samples, each predicted by the others of its texel, is least:
 *
 *     e_i = [A y]_i / A_ii,   A = (C + N)^-1
 *
 * which needs no fit without sample i (Dubrule 1983). What a number gains must be worth its distance from what is
 * usual, the fewer images there are the more. The texels of a set share the work; many sets are much work. *error_of
 * receives the relative root mean square of e, 0 where every sample is 0. Uses OpenMP; the number of threads leaves no
 * trace. Errors: WEFT_SYSTEM, WEFT_BAD_INPUT for samples that are no numbers. */
weft_code weft_kriging_choose(const weft_kriging_samples *set, int set_count, const weft_progress *progress,
                              weft_covariance *covariance, double *error_of, weft_error *error);

/* The same for the mean over the texels, whose set has one series a channel. So few series say little: they must gain
 * more for each step away from what is usual, and powers stay as they usually are. *covariance is not of a mean where
 * there are too few images to decide. */
weft_code weft_kriging_choose_mean(const weft_kriging_samples *set, const weft_progress *progress,
                                   weft_covariance *covariance, double *error_of, weft_error *error);

/* *error_of a covariance that is given. */
weft_code weft_kriging_leave_out(const weft_kriging_samples *set, int set_count, const weft_covariance *covariance,
                                 double *error_of, weft_error *error);

#endif
