/* What the photographs under one light, the one along the normal, say about all the others (reflectance/bard/bard.h).
 */
#ifndef WEFT_COMPRESS_BARD_PREDICT_H
#define WEFT_COMPRESS_BARD_PREDICT_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "evaluate/error/measurement.h"
#include "reflectance/bard/bard.h"

typedef struct weft_bard_options {
    weft_bard_map map;
    double diffuse_share; /* 0..1: share of a texel's smallest value over the views that is its diffuse albedo, which is
                             neither mapped nor scaled; 0 as in the article, whose black satin has none */
} weft_bard_options;

/* In the plane, 1. */
weft_bard_options weft_bard_defaults(void);

typedef struct weft_bard_report {
    int photograph_count, image_count; /* the first of them were used, the second are in the dataset */
    double largest_tilt_deg;           /* of the lights that were used, from the normal */
    long filled_count;                 /* samples of the table that were masked, taken from the nearest valid view */
    long empty_texel_count;            /* texels without any valid sample in the table: written as missing */
    weft_error_summary all;            /* of the predicted images against the valid samples, as reflectance times cosine
                                             or as the dataset holds it; over an even choice of texels where there are
                                             many */
    weft_error_summary by_light[WEFT_RING_COUNT]; /* rings of ubo81 */
} weft_bard_report;

/* Predicts every image of a far dataset from those of the light along the normal (of each view the image lit from
 * nearest the normal) and writes a dataset of the same layout: these photographs as they are (masked samples filled),
 * all others predicted. Predictions are per texel, rho_d + gain * (table - rho_d) with the table interpolated between
 * the views of its photographs, times the cosine where the dataset holds it. Memory does not grow with the number of
 * texels, but for opacity where there is any. Errors: WEFT_BAD_INPUT for a near dataset, no light within 7.5 degrees of
 * the normal, or fewer than 3 views under it; WEFT_BAD_USAGE where `output` is the dataset itself; those of reading and
 * writing. */
weft_code weft_bard_predict(weft_dataset *dataset, const char *output, const weft_bard_options *options,
                            const weft_progress *progress, weft_bard_report *report, weft_error *error);

/* Errors: WEFT_BAD_INPUT where `path` is no dataset that weft_bard_predict wrote; those of weft_dataset_open. */
weft_code weft_bard_check(const char *path, weft_error *error);

/* ---- Texels in memory ---- */

/* How many photographs under the light along the normal a layout has, one a view, without those with left_out[image] !=
 * 0 (NULL: none); 0 where it has no use for them: a near dataset, no such light, too few views. Thread-safe. */
int weft_bard_count_photographs(const weft_dataset_layout *layout, const uint8_t *left_out);

/* Predicts every image of every texel from these photographs: `samples` [texel_count][image_count][3] and `mask`
 * [texel_count][image_count] are measured, predicted [texel_count][image_count][3] is in the quantity of the layout; a
 * photograph that is used predicts itself. NaN for a texel without a valid photograph. Errors: WEFT_BAD_INPUT where
 * weft_bard_count_photographs is 0; WEFT_SYSTEM for memory. */
weft_code weft_bard_predict_texels(const weft_dataset_layout *layout, const uint8_t *left_out,
                                   const weft_bard_options *options, const weft_half *samples, const uint8_t *mask,
                                   long texel_count, weft_half *predicted, weft_error *error);

#endif
