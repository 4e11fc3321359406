/* What a model says of the samples of a dataset: the same question to a material, a weave and another dataset. */
#ifndef WEFT_EVALUATE_ERROR_PREDICTOR_H
#define WEFT_EVALUATE_ERROR_PREDICTOR_H

#include "btf/dataset/dataset.h"
#include "btf/direction/triangulation.h"
#include "btf/material/material.h"
#include "reflectance/microcylinder/microcylinder.h"
#include "reflectance/relief/relief.h"
#include "reflectance/weave/weave.h"

/* ---- Window ---- */

/* A dataset that is a window of another, through the heights of which it is seen. */

/* Where the texels of a dataset lie in a larger one. */
typedef struct weft_predicted_window {
    int x, y;                      /* the first */
    int whole_width, whole_height; /* texels */
} weft_predicted_window;

/* The taps of a view (weft_relief_taps) from texel (x, y) of the window of width x height texels, in coordinates of the
 * window. What lies beyond the middles of its outermost texels is not known: NaN. A window that is the whole repeats.
 * Thread-safe. */
void weft_window_taps(const weft_relief *relief, const weft_predicted_window *window, int width, int height, int x,
                      int y, weft_vec3 view, const int index[3], const weft_real weight[3], weft_relief_tap tap[3]);

typedef struct weft_predictor weft_predictor;

/* Predictions for one dataset, whose layout outlives the predictor. The caller frees with weft_predictor_free. */

/* Level 0 of a material, which stays the caller's: its components where it has some, through its heights where it has
 * those, else its lobes. The layout of the dataset is enough. Errors: WEFT_BAD_INPUT where its size is not that of the
 * dataset.
 */
weft_code weft_predictor_of_material(const weft_dataset_layout *layout, const weft_material *material,
                                     weft_predictor **result, weft_error *error);

/* The same of a dataset that is a window of another, whose heights the material has. What some view saw beyond the
 * window is not known: NaN. */
weft_code weft_predictor_of_window(const weft_dataset_layout *layout, const weft_predicted_window *window,
                                   const weft_material *material, weft_predictor **result, weft_error *error);

/* A weave without its noise; a texel is the mean of 4 x 4 points. `tiles` lays it on the dataset or, where that is a
 * window of another (NULL: it is none), on the whole of that. The weave stays the caller's. Errors: WEFT_SYSTEM. */
weft_code weft_predictor_of_weave(const weft_dataset_layout *layout, const weft_predicted_window *window,
                                  const weft_weave *weave, const weft_weave_layout *tiles, weft_predictor **result,
                                  weft_error *error);

/* Microcylinder cloth, which is alike at all texels; threads count by area. */
weft_code weft_predictor_of_threads(const weft_dataset_layout *layout, const weft_microcylinder_cloth *cloth,
                                    weft_predictor **result, weft_error *error);

/* The samples of another dataset, such as `weft bard` writes. Errors: WEFT_BAD_INPUT where it cannot be read, or its
 * size, images or quantity are not those of the dataset. */
weft_code weft_predictor_of_dataset(const weft_dataset *dataset, const char *path, weft_predictor **result,
                                    weft_error *error);

/* Samples [height][width][image_count][3] in the quantity of the layout, which the predictor takes over and frees,
 * also on failure. Errors: WEFT_SYSTEM for memory. */
weft_code weft_predictor_of_samples(const weft_dataset_layout *layout, weft_half *samples, weft_predictor **result,
                                    weft_error *error);

void weft_predictor_free(weft_predictor *predictor);

/* To be called before predictions for rows [y, y + rows). Errors: those of reading. */
weft_code weft_predictor_prepare_rows(weft_predictor *predictor, int y, int rows, weft_error *error);

/* The predictions for texel (x, y) in images image [image_count], in the quantity of the dataset. Thread-safe between
 * two calls of weft_predictor_prepare_rows. */
void weft_predictor_predict(const weft_predictor *predictor, int x, int y, const int *image, int image_count,
                            weft_rgb *prediction);

#endif
