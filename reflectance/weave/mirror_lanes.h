/* The equations of reflectance/woven/mirror.h and segment.c in vectors of floats, for the kernels: same names, same
 * order. Private to the room. */
#ifndef WEFT_REFLECTANCE_WEAVE_MIRROR_LANES_H
#define WEFT_REFLECTANCE_WEAVE_MIRROR_LANES_H

#include "base/lanes.h"
#include "reflectance/woven/mirror.h"

#define WEFT_LANE_PI 3.14159265f
#define WEFT_LANE_HALF_PI 1.57079637f
#define WEFT_LANE_HALF_PI_REST (-4.37113883e-8f) /* pi/2 minus that */

WEFT_INLINE lanes lanes_abs(lanes x)
{
    return (lanes)((lane_bits)x & 0x7fffffff);
}

/* |x| with the sign of `sign`. */
WEFT_INLINE lanes lanes_sign_of(lanes sign, lanes x)
{
    return (lanes)(((lane_bits)x & 0x7fffffff) | ((lane_bits)sign & INT32_MIN));
}

/* sin x, |x| <= pi/2: x P(x^2) with P truncated from its Chebyshev series; relative error 7e-9 before rounding. */
WEFT_INLINE lanes lanes_sin(lanes x)
{
    lanes s = x * x;
    lanes p = -0.000198090438f + s * 2.6051604e-06f;
    p = -0.16666658f + s * (0.00833305058f + s * p);
    return x * (0.999999996f + s * p);
}

/* cos x, |x| <= pi/2, to full relative precision also near the ends; 0 a little beyond them. */
WEFT_INLINE lanes lanes_cos(lanes x)
{
    return lanes_sin(lanes_max(WEFT_LANE_HALF_PI - lanes_abs(x) + WEFT_LANE_HALF_PI_REST, lanes_of(0)));
}

/* atan(y / x) for x > 0: on [0, 1] a polynomial from the Chebyshev series of atan(t) / t, relative error 1.6e-8. */
WEFT_INLINE lanes lanes_atan(lanes y, lanes x)
{
    lanes a = lanes_abs(y);
    lane_bits steep = a > x;
    lanes t = lanes_select(steep, x, a) / lanes_select(steep, a, x), s = t * t;
    lanes p = -0.0160050305f + s * 0.00283406429f;
    p = -0.0749544544f + s * (0.0425876074f + s * p);
    p = -0.142025705f + s * (0.106367541f + s * p);
    p = -0.333330668f + s * (0.199924836f + s * p);
    p = t * (0.999999984f + s * p);
    return lanes_sign_of(y, lanes_select(steep, WEFT_LANE_HALF_PI - p, p));
}

typedef struct lane_vec3 {
    lanes x, y, z;
} lane_vec3;

WEFT_INLINE lane_vec3 lane_vec3_of(float x, float y, float z)
{
    return (lane_vec3){lanes_of(x), lanes_of(y), lanes_of(z)};
}

WEFT_INLINE lanes lanes_dot(lane_vec3 a, lane_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

typedef struct lane_mirror {
    lanes sin_u, cos_u, sin_v, cos_v;
    lanes light_share, view_share, cosine_sum;
} lane_mirror;

/* Fills the shares; where it says no they mean nothing. */
WEFT_INLINE lane_bits lanes_faces_both(lane_mirror *at, lane_vec3 light, lane_vec3 view)
{
    lane_vec3 normal = {at->sin_v, at->sin_u * at->cos_v, at->cos_u * at->cos_v};
    lanes c1 = lanes_dot(normal, light), c2 = lanes_dot(normal, view), inverse_sum;
    at->cosine_sum = c1 + c2;
    inverse_sum = 1 / at->cosine_sum;
    at->light_share = c1 * inverse_sum;
    at->view_share = c2 * inverse_sum;
    return (at->cos_v > 0.0f) & (c1 > 0.0f) & (c2 > 0.0f) & (at->cosine_sum > (float)WEFT_MIN_COSINE_SUM);
}

/* Eq. 3: sine and cosine of v for D = cot(psi) along / hypot(H_x, across). */
WEFT_INLINE lane_bits lanes_staple_mirror(lanes cot_psi, lanes half_x, lanes along, lanes across, lane_mirror *at)
{
    lanes norm = lanes_sqrt(half_x * half_x + across * across), projected = cot_psi * along;
    lanes inverse_norm = 1 / norm, cosine = projected * inverse_norm;
    lanes sine = lanes_sqrt(lanes_max((1 - cosine) * (1 + cosine), lanes_of(0)));
    at->sin_v = (half_x * sine - across * cosine) * inverse_norm;
    at->cos_v = (half_x * cosine + across * sine) * inverse_norm;
    return lanes_abs(projected) < norm;
}

typedef struct lane_spine {
    lanes umax, sin_umax, cos_umax, shape, scale;
} lane_spine;

WEFT_INLINE lane_spine lanes_spine(lanes kappa, lanes width, lanes length, lanes umax)
{
    lane_spine s = {.umax = umax, .sin_umax = lanes_sin(umax), .cos_umax = lanes_cos(umax)};
    s.shape = (1 + kappa) + kappa * (s.cos_umax / s.sin_umax);
    lanes hyperbola = (1 + kappa) * (s.cos_umax + s.sin_umax) * (s.cos_umax - s.shape * s.sin_umax);
    lanes ellipse = s.cos_umax * s.cos_umax + s.shape * s.shape * s.sin_umax * s.sin_umax;
    lanes end = lanes_select(s.shape < 0.0f, hyperbola, ellipse);
    /* Not below 0: sin umax may be the larger one by rounding. */
    lanes half_length = 0.5f * lanes_max(length - width * s.sin_umax, lanes_of(0));
    s.scale = half_length / s.sin_umax * lanes_sqrt(end);
    return s;
}

/* R at u; `inside` = umax - |u|. */
WEFT_INLINE lanes lanes_spine_radius(lanes kappa, const lane_spine *spine, lanes inside, lanes sin_u, lanes cos_u)
{
    cos_u = lanes_max(cos_u, spine->cos_umax);
    lanes sin_abs_u = lanes_abs(sin_u), end = (1 + kappa) * (spine->sin_umax + spine->cos_umax);
    lanes hyperbola = (lanes_sin(lanes_max(inside, lanes_of(0))) + end * sin_abs_u) / spine->sin_umax *
                      (cos_u - spine->shape * sin_abs_u);
    lanes ellipse = cos_u * cos_u + spine->shape * spine->shape * sin_u * sin_u;
    lanes e = lanes_select(spine->shape < 0.0f, hyperbola, ellipse);
    return spine->scale / (e * lanes_sqrt(e));
}

/* a (R + a cos v). */
WEFT_INLINE lanes lanes_yarn_area(lanes width, lanes radius, lanes cos_v)
{
    lanes yarn_radius = 0.5f * width;
    return yarn_radius * (radius + yarn_radius * cos_v);
}

#endif
