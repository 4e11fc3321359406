/* What a completion learns from: images, with the samples that a few texels have of them. */
#ifndef WEFT_COMPRESS_COMPONENTS_KNOWN_H
#define WEFT_COMPRESS_COMPONENTS_KNOWN_H

#include "base/progress.h"
#include "compress/components/training.h"
#include "compress/kriging/kriging.h"

/* Three series a texel, one a channel. Freed with weft_known_free. */
typedef struct weft_known {
    int count, series_count;
    int *image;                /* [count] of the images of components */
    weft_direction_pair *pair; /* [count] */
    double *weight;            /* [count] */
    double *sample;            /* [series_count][count] */
} weft_known;

/* The samples of texels first .. last at an even choice of at most `most` of the images that any of them has. Errors:
 * WEFT_SYSTEM for memory. */
weft_code weft_known_take(const weft_training *training, const weft_component_images *images, int first, int last,
                          int most, weft_known *known, weft_error *error);
void weft_known_free(weft_known *known);

/* Where the images lie. They stay those of `known`. */
weft_kriging_places weft_known_places(const weft_known *known);

/* The mean square of all samples; 0 where there is none. */
double weft_known_mean_square(const weft_known *known);

/* Number i of `some` that are an even choice of `all`. */
int weft_even_choice(int i, int some, int all);
int weft_at_most(int count, int most);

/* ---- The mean texel ---- */

/* The mean over the texels that a completion learns from. It is smoother than they are, and nearly without noise: by a
 * covariance of its own, which knows that it is reciprocal (compress/kriging/covariance.h), it is predicted much better
 * than the mean of what kriging says of the texels is. */

/* Its three channels at the images of `known`. The caller frees *sample [3][known->count]. Errors: WEFT_SYSTEM. */
weft_code weft_mean_texel_take(const weft_known *known, double **sample, weft_error *error);

/* Chooses its covariance by leaving each image of `known` out. `texels` is that of the texels: where it predicts the
 * mean as well, *covariance is not of a mean, and nothing more is to be done. error_of[0] receives the relative root
 * mean square by `texels`, error_of[1] by *covariance. Errors: WEFT_SYSTEM, WEFT_BAD_INPUT. */
weft_code weft_mean_texel_choose(const weft_known *known, const weft_covariance *texels, const weft_progress *progress,
                                 weft_covariance *covariance, double error_of[2], weft_error *error);

/* Scales every channel of what is said of each of `images` such that its mean over `training` is what kriging says of
 * the mean, from `sample` of weft_mean_texel_take. All views of `images` have as many lights. Errors: WEFT_SYSTEM,
 * WEFT_BAD_INPUT. */
weft_code weft_mean_texel_impose(const weft_known *known, double *sample, const weft_covariance *covariance,
                                 const weft_component_images *images, weft_training *training, weft_error *error);

#endif
