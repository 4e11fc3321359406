/* Arithmetic of vectors (weft/types.h). Within the library the directions `light` and `view` are unit. All functions
 * are pure. */
#ifndef WEFT_BASE_VECTOR_H
#define WEFT_BASE_VECTOR_H

#include "base/real.h"

#include <tgmath.h>

/* No compound literal: C++ includes this, too. */
static inline weft_vec3 weft_vec3_of(weft_real x, weft_real y, weft_real z)
{
    weft_vec3 v = {x, y, z};
    return v;
}

static inline weft_vec3 weft_add(weft_vec3 a, weft_vec3 b)
{
    return weft_vec3_of(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline weft_vec3 weft_subtract(weft_vec3 a, weft_vec3 b)
{
    return weft_vec3_of(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline weft_vec3 weft_scale(weft_vec3 a, weft_real s)
{
    return weft_vec3_of(a.x * s, a.y * s, a.z * s);
}

static inline weft_real weft_dot(weft_vec3 a, weft_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline weft_vec3 weft_cross(weft_vec3 a, weft_vec3 b)
{
    return weft_vec3_of(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline weft_real weft_length(weft_vec3 a)
{
    return sqrt(weft_dot(a, a));
}

/* The unit vector along `a`; the zero vector stays zero. */
static inline weft_vec3 weft_unit(weft_vec3 a)
{
    weft_real length = weft_length(a);
    return length > 0 ? weft_scale(a, 1 / length) : a;
}

static inline weft_real weft_clamp(weft_real x, weft_real low, weft_real high)
{
    return x < low ? low : x > high ? high : x;
}

#endif
