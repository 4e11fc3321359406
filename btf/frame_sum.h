/* The average frame of many places of a surface (Daubert et al. 2001, section 4): what the frames of a texel's places
 * add up to, each with its weight. All functions are pure. */
#ifndef WEFT_BTF_FRAME_SUM_H
#define WEFT_BTF_FRAME_SUM_H

#include "btf/material.h"

/* Begins as {0}. */
typedef struct weft_frame_sum {
    weft_vec3 normal;     /* sum of w n */
    weft_real xx, yy, zz; /* sum of w t t^T: a tangent is an axis, its sign means nothing */
    weft_real xy, yz, zx;
} weft_frame_sum;

/* Adds a place with the unit vectors `normal` and `tangent`. */
void weft_frame_sum_add(weft_frame_sum *sum, weft_vec3 normal, weft_vec3 tangent, weft_real weight);

/* Adds all places of another sum, each weight times `factor`. */
void weft_frame_sum_merge(weft_frame_sum *sum, const weft_frame_sum *other, weft_real factor);

/* The frame whose normal is the unit vector of the sum of w n, not below the horizon, and whose tangent is the axis
 * perpendicular to it with the largest sum of w (t . axis)^2, its x positive. Normal z and tangent x for an empty sum.
 */
weft_frame weft_frame_of_sum(const weft_frame_sum *sum);

#endif
