/* The mean BRDF of a dataset: what a reflectance model without texture has to explain. */
#ifndef WEFT_COMPRESS_WEAVE_FIT_MEAN_BRDF_H
#define WEFT_COMPRESS_WEAVE_FIT_MEAN_BRDF_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "btf/direction/direction.h"

/* Owned by the caller. */
typedef struct weft_mean_brdf {
    int count;               /* images with a valid texel, light and view above the horizon */
    weft_vec3 *light, *view; /* [count] as the centre of the material sees them */
    weft_rgb *value;         /* [count] 1/sr, mean over the valid texels */
} weft_mean_brdf;

/* A part of the material, texels, x to the right and y down from its upper left corner. What repeats with a period, at
 * most the size of the window, counts once, as the mean of how often the window shows it; period 0: every texel counts
 * alike. */
typedef struct weft_texel_window {
    double left, top, width, height;
    double period_x, period_y;
} weft_texel_window;

/* Over `window`, texels that it cuts with the share inside; NULL: the whole material. Reads it block by block. Errors:
 * WEFT_BAD_INPUT where nothing is valid; those of reading; WEFT_SYSTEM for memory. */
weft_code weft_mean_brdf_of(weft_dataset *dataset, const weft_texel_window *window, const weft_progress *progress,
                            weft_mean_brdf *mean, weft_error *error);
void weft_mean_brdf_free(weft_mean_brdf *mean);

#endif
