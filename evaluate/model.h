/* One value of a model at a time (weft/evaluate.h), and tables of them. */
#ifndef WEFT_EVALUATE_MODEL_H
#define WEFT_EVALUATE_MODEL_H

#include "base/progress.h"
#include "base/text/csv.h"
#include "btf/dataset/dataset.h"
#include "reflectance/weave/weave.h"
#include "weft/evaluate.h"

#include <stdio.h>

/* What to evaluate. */
typedef struct weft_query {
    weft_vec3 light, view; /* unit */
    bool has_place;        /* else the mean over the whole material (of a weave: over its tile, without noise) */
    weft_real u, v;        /* in units of the material; of a weave in units of its tile */
    weft_real level;       /* mip level of a material; 0 for the others */
} weft_query;

/* BRDF in 1/sr, without the cosine; 0 below the horizon; NaN where a dataset holds no valid sample. The mean over a
 * material is that of all texels of its level (between two levels, interpolated). Thread-safe where
 * weft_model_is_thread_safe. Errors: WEFT_BAD_INPUT for a level that is negative, or not 0 in a model without levels;
 * reading a dataset may fail. */
weft_code weft_model_brdf(weft_model *model, const weft_query *query, weft_rgb *brdf, weft_error *error);

/* Half the width of the interval about what weft_model_brdf said, 1/sr, where the options ask for it; 0 below the
 * horizon. Pure. */
weft_rgb weft_model_half_width(const weft_model *model, const weft_query *query, const weft_rgb *brdf);

/* All but datasets are. Pure. */
bool weft_model_is_thread_safe(const weft_model *model);

/* Opacity at a place, 0 .. 1; the light takes no part. Thread-safe. */
weft_real weft_model_opacity(const weft_model *model, const weft_query *query);

/* Whether the options asked for intervals. Pure. */
bool weft_model_has_interval(const weft_model *model);

/* Evaluates the rows of a table with the columns lx, ly, lz, vx, vy, vz and maybe u and v, level; others are kept.
 * Writes the same rows with r, g, b
 * (%.9g) appended and, with intervals, their ends r_low, r_high, ..., of which the lower are at least 0. Directions are
 * normalised. Errors: WEFT_BAD_INPUT "FILE:LINE: ...", and where intervals are asked for without u and v: they are of
 * places; WEFT_SYSTEM where `output` cannot be written. */
weft_code weft_model_evaluate_table(weft_model *model, const weft_csv *table, const weft_progress *progress,
                                    FILE *output, weft_error *error);

/* ---- Raw BTF ---- */

/* A dataset as a function: its samples interpolated between the measured lights and views. */

typedef struct weft_raw_btf weft_raw_btf;

/* `dataset` stays the caller's and must outlive the result, which the caller frees with weft_raw_btf_free.
 * Errors: WEFT_SYSTEM for memory. */
weft_code weft_raw_btf_create(weft_dataset *dataset, weft_raw_btf **result, weft_error *error);
void weft_raw_btf_free(weft_raw_btf *raw);

/* From now on without the heights of the dataset. */
void weft_raw_btf_flatten(weft_raw_btf *raw);

/* BRDF in 1/sr at texture coordinates (u, v), repeated: bilinear between texels; in a texel barycentric between the
 * three nearest views and, within each, between its three nearest lights (btf/direction/triangulation.h). Samples are
 * divided by the cosine of their own light before they are interpolated, so that a diffuse texel stays constant. Masked
 * samples take no part: the weights of the others are scaled up; NaN where none is left. 0 where light or view is below
 * the horizon. Not thread-safe. */
weft_code weft_raw_btf_sample(weft_raw_btf *raw, weft_real u, weft_real v, weft_vec3 light, weft_vec3 view,
                              weft_rgb *brdf, weft_error *error);

/* The same for the mean of all texels, each image over its valid samples; directions of a near dataset are those at its
 * centre. The first call reads the whole dataset. */
weft_code weft_raw_btf_mean(weft_raw_btf *raw, weft_vec3 light, weft_vec3 view, weft_rgb *brdf, weft_error *error);

#endif
