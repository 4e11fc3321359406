/* A weave as a texture of four floats per texel, for reflectance/weave/weave.glsl. */
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

#endif
