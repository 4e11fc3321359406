/* How well the other photographs tell one of a view that is left out: through heights, a plane, or the plane of the
 * texels. Private to this folder. */
#ifndef WEFT_RELIEF_HELD_OUT_H
#define WEFT_RELIEF_HELD_OUT_H

#include "relief/features.h"

/* Of 62 degrees: steeper views are not compared. */
#define WEFT_HELD_OUT_STEEPEST_COSINE 0.46947156278589

/* Squares summed over texels and features. */
typedef struct weft_held_out {
    double residual, energy;
} weft_held_out;

/* Relative RMSE; 0 where the energy is. Pure. */
double weft_held_out_error(const weft_held_out *held_out);

/* A view that is left out, and its neighbours among the others. */
typedef struct weft_left_out {
    int view;
    int neighbour[3]; /* -1: none */
    weft_real weight[3];
} weft_left_out;

/* The views that can be left out: not steeper than 62 degrees, and inside a triangle of others. result [view_count of
 * the features]; returns their number in *count. Errors: WEFT_SYSTEM. */
weft_code weft_left_out_find(const weft_features *features, weft_left_out *result, int *count, weft_error *error);

/* Predicts every view of `left_out` [count] in turn from all others through height_mm [height][width] (1 x 1: a plane),
 * in about `most_texels` texels at most. result [count]. Errors: WEFT_SYSTEM. */
weft_code weft_held_out_predict(const weft_features *features, const float *height_mm, int width, int height,
                                const weft_left_out *left_out, int count, long most_texels, weft_held_out *result,
                                weft_error *error);

#endif
