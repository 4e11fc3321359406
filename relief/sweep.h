/* A sweep of heights: how badly the views agree at each. Private to this folder.
 *
 * At a height h, view k shows of the grid point p what it holds at q = p - h s(k) (reflectance/relief/relief.h). With
 * f_k its features there and m their mean, the cost is the mean over the views of
 *
 *     rho / (sigma^2 + rho),    rho = |f_k - m|^2 / e,    e = mean of |f_k|^2
 *
 * (Geman and McClure 1987), m weighted in three rounds by 1 / (sigma^2 + rho)^2, so that a view that sees something
 * else has no say. Dividing by the energy e of the hypothesis itself makes dark and bright places alike. */
#ifndef WEFT_RELIEF_SWEEP_H
#define WEFT_RELIEF_SWEEP_H

#include "base/processor.h"
#include "relief/features.h"

#define WEFT_SWEEP_SIGMA_SQUARED 0.15f

enum { WEFT_SWEEP_ROUNDS = 3, WEFT_SWEEP_MOST_VIEWS = 128 };

/* Heights low .. high mm at even steps, on a grid of `scale` x `scale` points in a texel. */
typedef struct weft_sweep {
    const weft_features *features;
    const int *view; /* [view_count] those that are compared */
    int view_count, scale, step_count;
    double low, high;
    float least_energy; /* added to e: a black place agrees with nothing */
} weft_sweep;

/* cost [step_count][features height x scale][features width x scale]; 1 where fewer than half of the views see the
 * material. */
void weft_sweep_run(const weft_sweep *sweep, float *cost);

/* One row of the grid at one height: the features where each view shows them begin at `x` [view] (in texels, wrapped
 * into the material where it repeats) and lie in rows y, y + 1 with the share `down` of the second. */
typedef struct weft_sweep_row {
    const weft_features *features;
    const int *view;
    int view_count, scale;
    float least_energy;
    float x[WEFT_SWEEP_MOST_VIEWS], down[WEFT_SWEEP_MOST_VIEWS];
    int y[WEFT_SWEEP_MOST_VIEWS][2]; /* -1: outside */
} weft_sweep_row;

/* cost [width x scale]. Compiled for every instruction set. */
typedef void weft_sweep_kernel(const weft_sweep_row *row, float *cost);

#define WEFT_DECLARE_SWEEP_KERNEL(set) weft_sweep_kernel weft_sweep_row_##set

WEFT_FOR_EACH_SET(WEFT_DECLARE_SWEEP_KERNEL);

#endif
