/* A weave as textures of four floats per texel, for reflectance/weave/weave.glsl and weave_mean.glsl. */
#ifndef WEFT_REFLECTANCE_WEAVE_SHADER_TABLE_H
#define WEFT_REFLECTANCE_WEAVE_SHADER_TABLE_H

#include "reflectance/weave/weave.h"

/* Texel i lies in column i mod WEFT_WEAVE_TABLE_WIDTH, row i / WEFT_WEAVE_TABLE_WIDTH.
 *     0                 tile width, tile height (cells), number of yarns, 0
 *     1                 fineness, period (cells), 0, 0
 *     2                 inclination noise: warp over warp, warp over weft, weft over warp, weft over weft (rad)
 *     3 + 6 k + 0       yarn k: alpha, beta, delta, phase scale
 *             + 1       cot psi, 1 / |sin psi| (0 = filament), umax (rad), kappa
 *             + 2       width, length (cells), highlight width, area weight (0 where there is no such segment)
 *             + 3       center u, center v (tile units), 1 = warp or 0 = weft, least umax under noise (rad)
 *             + 4       kd r, g, b; largest umax under noise (rad)
 *             + 5       ks r, g, b times the specular scale s; share of umax where the
 *                       spine that gives the radius ends
 *     3 + 6 yarns + j   pattern cells 4 j .. 4 j + 3, row by row from the top: index of the yarn */
enum { WEFT_WEAVE_TABLE_WIDTH = 256, WEFT_WEAVE_TABLE_HEADER = 3, WEFT_WEAVE_TABLE_YARN = 6 };

/* Sets *width and *height, in texels, and fills `rgba` [height][width][4], owned by the caller, unless it is NULL.
 * Pure. */
void weft_weave_table(const weft_weave *weave, float *rgba, int *width, int *height);

/* The mean over the tile, sum_k F_k (kd/pi + ks s aw f_s), with one row of texels for each kind of yarn:
 *     0     sum of F ks s aw over the yarns of the kind, r, g, b; 1 = warp or 0 = weft
 *     1     sum of F kd / pi over all yarns, r, g, b; 0
 *     2     alpha, beta, phase scale, width / 2 (cells)
 *     3     cot psi, 1 / |sin psi| (0 = filament), shape |shape| and scale of the spine
 *     4     sine and cosine of the largest umax of the kind, and it (rad; 0: it has no highlight); 0
 *     5 + i radius R of the spine at |u| = i / STEPS of that umax, and 1 where there is such a yarn, both times the
 * fade of a filament and as the mean over the inclinations of its segments; the same at i + 1 */
enum { WEFT_WEAVE_MEAN_STEPS = 256, WEFT_WEAVE_MEAN_WIDTH = 5 + WEFT_WEAVE_MEAN_STEPS };

typedef struct weft_weave_means {
    int kinds;
    bool noisy;                      /* staples take their radius from the steps, too */
    bool has_staples, has_filaments; /* with a highlight */
    float (*texel)[4];               /* [kinds][WEFT_WEAVE_MEAN_WIDTH] */
} weft_weave_means;

/* `noisy`: with the noise of inclination. Errors: WEFT_SYSTEM for memory. The caller frees with weft_weave_means_free,
 * also on failure. */
weft_code weft_weave_means_of(const weft_weave *weave, bool noisy, weft_weave_means *means, weft_error *error);
void weft_weave_means_free(weft_weave_means *means);

/* weft_weave_mean_brdf as it is drawn. Filaments have closed integrals round the yarn; those along staples are sums
 * over 12 places. docs/notes/weaves.md has the errors. Pure. */
weft_rgb weft_weave_tabulated_mean(const weft_weave_means *means, weft_vec3 light, weft_vec3 view);

#endif
