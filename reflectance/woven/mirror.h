/* Where the fibres of a yarn mirror the light into the view: the equations shared by the point, texture and integral
 * evaluations of a segment, also by the kernels of reflectance/weave.
 *
 * H = light + view is not normalised. Sines and cosines of u and v are carried instead of the angles, because the
 * normal n(u, v) = (sin v, sin u cos v, cos u cos v) and all conditions need only those. */
#ifndef WEFT_REFLECTANCE_WOVEN_MIRROR_H
#define WEFT_REFLECTANCE_WOVEN_MIRROR_H

#include "reflectance/woven/woven.h"

/* Below these the half vector or its part across a yarn is rounding noise. */
#define WEFT_MIN_HALF_SQUARED 1e-12
#define WEFT_MIN_ACROSS 1e-15
#define WEFT_MIN_COSINE_SUM 1e-30

typedef struct weft_mirror {
    weft_real sin_u, cos_u, sin_v, cos_v;
    weft_real light_share, view_share; /* c1 / (c1 + c2), c2 / (c1 + c2) */
    weft_real cosine_sum;              /* c1 + c2 = |H| n.h */
} weft_mirror;

static inline bool half_vector(weft_vec3 light, weft_vec3 view, weft_vec3 *half)
{
    *half = weft_add(light, view);
    return light.z > 0 && view.z > 0 && weft_dot(*half, *half) >= (weft_real)WEFT_MIN_HALF_SQUARED;
}

/* Whether n(u, v) is on the upper half of the yarn and faces both directions; fills the shares. */
static inline bool faces_both(weft_mirror *at, weft_vec3 light, weft_vec3 view)
{
    if (!(at->cos_v > 0))
        return false;
    weft_vec3 normal = {at->sin_v, at->sin_u * at->cos_v, at->cos_u * at->cos_v};
    weft_real c1 = weft_dot(normal, light), c2 = weft_dot(normal, view);
    at->cosine_sum = c1 + c2;
    if (!(c1 > 0 && c2 > 0 && at->cosine_sum > (weft_real)WEFT_MIN_COSINE_SUM))
        return false;
    weft_real inverse_sum = 1 / at->cosine_sum;
    at->light_share = c1 * inverse_sum;
    at->view_share = c2 * inverse_sum;
    return true;
}

/* Staple (eq. 3): v = atan2(-across, H_x) + acos(D), D = cot(psi) along / hypot(H_x, across), with
 * along = H_y cos u - H_z sin u and across = H_y sin u + H_z cos u. Sine and cosine of v come from the addition
 * theorem, which also makes the wrap into (-pi, pi] unnecessary. */
static inline bool staple_mirror(weft_real cot_psi, weft_real half_x, weft_real along, weft_real across,
                                 weft_mirror *at)
{
    weft_real norm = sqrt(half_x * half_x + across * across);
    weft_real projected = cot_psi * along;
    if (!(fabs(projected) < norm))
        return false;
    weft_real inverse_norm = 1 / norm;
    weft_real cosine = projected * inverse_norm;
    weft_real sine = sqrt(fmax((1 - cosine) * (1 + cosine), 0));
    at->sin_v = (half_x * sine - across * cosine) * inverse_norm;
    at->cos_v = (half_x * cosine + across * sine) * inverse_norm;
    return true;
}

/* Filament (eq. 4): tan u = H_y / H_z. Returns hypot(H_y, H_z), or 0 where the half vector lies across the yarn. */
static inline weft_real filament_mirror(weft_vec3 half, weft_mirror *at)
{
    weft_real across = sqrt(half.y * half.y + half.z * half.z);
    if (!(across > (weft_real)WEFT_MIN_ACROSS))
        return 0;
    at->sin_u = half.y / across;
    at->cos_u = half.z / across;
    return across;
}

/* Radius of curvature at u; `inside` = umax - |u| beside sine and cosine because it decides near the ends. */
weft_real weft_spine_radius_at(const weft_segment *segment, const weft_spine *spine, weft_real inside, weft_real sin_u,
                               weft_real cos_u);

/* The same at the highlight of a filament, whose radius may be frozen toward the ends of `spine`. */
weft_real weft_filament_radius(const weft_prepared_segment *prepared, const weft_spine *spine, weft_real u,
                               weft_real sin_u, weft_real cos_u);

/* fc for x = -light . view. */
static inline weft_real prepared_phase(const weft_prepared_segment *prepared, weft_vec3 light, weft_vec3 view)
{
    weft_real beta = prepared->segment.beta, x = weft_clamp(-weft_dot(light, view), -1, 1);
    return prepared->segment.alpha + exp(beta * x - fabs(beta)) * prepared->phase_scale;
}

/* a (R + a cos v): area of yarn surface per unit of u and v. */
static inline weft_real yarn_area(const weft_segment *segment, weft_real radius, weft_real cos_v)
{
    weft_real yarn_radius = segment->width / 2;
    return yarn_radius * (radius + yarn_radius * cos_v);
}

/* Fade of a filament toward the ends of the segment (eq. 9), by the distance to the end: 1 - step(c) = step(1 - c),
 * which does not cancel where the fade ends. */
static inline weft_real filament_fade(weft_real delta, weft_real umax, weft_real u)
{
    if (!(delta > 0))
        return 1;
    weft_real inside = weft_clamp((umax - fabs(u)) / (delta * umax), 0, 1);
    return inside * inside * (3 - 2 * inside);
}

#endif
