/* A dataset as a function: its samples interpolated between the measured lights and views. */
#ifndef WEFT_EVALUATE_RAW_BTF_H
#define WEFT_EVALUATE_RAW_BTF_H

#include "btf/dataset/dataset.h"

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
