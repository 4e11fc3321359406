/* The heights of a material, from the costs of a sweep. Private to this folder. */
#ifndef WEFT_RELIEF_HEIGHT_MAP_H
#define WEFT_RELIEF_HEIGHT_MAP_H

#include "relief/features.h"

typedef struct weft_height_map {
    int width, height; /* places: those of the grid of the search */
    float *value;      /* [height][width] mm above the plane of the texels */
    float *confidence; /* [height][width] how much lower the least cost is than the mean over all heights */
} weft_height_map;

/* What a map is made from: some views of the features, heights low .. high mm in so many steps, a grid of scale x scale
 * points in a texel. */
typedef struct weft_height_search {
    const weft_features *features;
    const int *view; /* [view_count] */
    int view_count, step_count, scale;
    double low, high;
} weft_height_search;

/* Sweeps (relief/sweep.h), smooths the costs of every height (Gaussian), takes the least cost of a place and the vertex
 * of the parabola through it and its neighbours, and the median of 3 x 3 places.
 * Errors: WEFT_SYSTEM. The caller frees with weft_height_map_free. */
weft_code weft_height_map_find(const weft_height_search *search, weft_height_map *map, weft_error *error);
void weft_height_map_free(weft_height_map *map);

/* Means of 2 x 2 places; odd sizes lose their last row or column. Errors: WEFT_SYSTEM. */
weft_code weft_height_map_halve(const weft_height_map *map, weft_height_map *half, weft_error *error);

/* Narrows low .. high to where the more confident half of a wide search lies, with a margin. The finest levels are left
 * out where the search is many texels deep. Errors: WEFT_SYSTEM. */
weft_code weft_height_range_find(const weft_features *features, const int *view, int view_count, double *low,
                                 double *high, weft_error *error);

/* ---- How far heights are looked for ---- */

/* The least distance, mm, after which the cloth repeats along one of its axes, from the autocorrelation of the view
 * that looks down most steeply (base/numeric/repeat.h). Infinity where it repeats along neither. Errors: WEFT_SYSTEM.
 */
weft_code weft_relief_period(const weft_features *features, double *period_mm, weft_error *error);

/* Heights lie within reach_mm above and below the plane of the texels. A stitch is hardly taller than it is wide, so
 * 1.25 times its width is enough: the period of the cloth, or all of it where it is one tile. Further off, threads
 * agree with their neighbours by chance. Where nothing repeats, the reach is a quarter of the shorter side, but no more
 * than 24 texels: parallax is told as far as that. Errors: WEFT_SYSTEM. */
weft_code weft_relief_reach(const weft_features *features, double *reach_mm, weft_error *error);

/* ---- How well other views predict one that is left out: through heights, a plane, or the plane of the texels ---- */

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
