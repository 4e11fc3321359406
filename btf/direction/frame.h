/* Orthonormal frames of texels: from normals and tangents, as codes, and as averages over many places of a surface. All
 * functions are pure. */
#ifndef WEFT_BTF_DIRECTION_FRAME_H
#define WEFT_BTF_DIRECTION_FRAME_H

#include "base/vector.h"

#include <stdint.h>

typedef struct weft_frame {
    weft_vec3 normal, tangent, bitangent; /* orthonormal, right-handed: bitangent = normal x tangent */
} weft_frame;

/* The tangent is x projected on the plane of the unit vector `normal` (y where x is parallel to it), turned by
 * `azimuth_rad`. */
weft_frame weft_frame_of_normal(weft_vec3 normal, weft_real azimuth_rad);

/* From a normal and a tangent that need be neither unit nor orthogonal (any perpendicular vector where they are
 * parallel). */
weft_frame weft_frame_of_vectors(weft_vec3 normal, weft_vec3 tangent);

/* A direction in the coordinates of a frame. */
weft_vec3 weft_frame_local(const weft_frame *frame, weft_vec3 direction);

/* ---- The codes of a material file (docs/reference/weft-format.md, 3.3) ---- */

weft_frame weft_frame_decode(const int16_t code[3]);
void weft_frame_encode(const weft_frame *frame, int16_t code[3]);

/* ---- The average of the frames of many places, each with its weight (Daubert et al. 2001, section 4) ---- */

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
