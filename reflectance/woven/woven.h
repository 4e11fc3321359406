/* One yarn segment of woven cloth (Irawan and Marschner 2012, with the corrections of docs/reference/models.md). Pure
 * functions. Segment frame: y along the yarn, z the surface normal, x = y cross z. Directions are unit; every value is
 * 0 where one of them is below the horizon. GLSL twin: reflectance/woven/woven.glsl. */
#ifndef WEFT_REFLECTANCE_WOVEN_WOVEN_H
#define WEFT_REFLECTANCE_WOVEN_WOVEN_H

#include "base/vector.h"

#include <stdbool.h>

typedef struct weft_segment {
    weft_real alpha;           /* uniform scattering, >= 0 */
    weft_real beta;            /* concentration of forward scattering (von Mises) */
    weft_real delta;           /* fade length at the ends, 0..1; filament only */
    weft_real psi;             /* fibre twist, rad; 0 = filament, else staple */
    weft_real umax;            /* largest inclination of the spine, rad, 0 < umax <= pi/2 */
    weft_real kappa;           /* curvature of the spine, > -1 */
    weft_real width, length;   /* of the segment rectangle, cells; width sin(umax) < length */
    weft_real highlight_width; /* of width or length, 0 < highlight_width <= 1 */
    bool frozen_radius; /* filament: R of a spine that ends at (1 - delta) umax, constant beyond. Renderers do so, the
                           article does not */
} weft_segment;

/* Beyond these a segment counts as inadmissible: they keep every value finite in single precision. */
#define WEFT_SEGMENT_MIN_UMAX 1e-7
#define WEFT_SEGMENT_MIN_HIGHLIGHT_WIDTH 1e-4
#define WEFT_SEGMENT_MAX_PARAMETER 1e4

/* Whether such a segment exists. Every function below returns 0 for one that does not. */
bool weft_segment_admissible(const weft_segment *segment);

/* Radius of curvature R(u) of the spine at inclination u, |u| <= umax. */
weft_real weft_spine_radius(const weft_segment *segment, weft_real u);

/* Everything known at one point of the yarn. Where the highlight is not active all is 0 but radius and phase; where
 * there is no such point (directions below the horizon, |u| > umax) they are 0 too. */
typedef struct weft_yarn_point {
    bool active;           /* whether the highlight exists here */
    weft_real solved;      /* v for staple, u for filament */
    weft_vec3 normal;      /* n(u, v), unit */
    weft_real radius;      /* R */
    weft_real geometry;    /* G */
    weft_real phase;       /* fc */
    weft_real attenuation; /* A */
    weft_real integrand;   /* G fc A */
} weft_yarn_point;

/* Staple: coordinate = u, solves v (eq. 3). Filament: coordinate = v, solves u (eq. 4). */
weft_yarn_point weft_yarn_highlight(const weft_segment *segment, weft_real coordinate, weft_vec3 light, weft_vec3 view);

/* alpha + exp(beta x) / (2 pi I0(beta)) with x = -light . view, evaluated without overflow (eq. 7). */
weft_real weft_phase_function(weft_real alpha, weft_real beta, weft_real x);

/* Reflectance of the whole segment (eq. 1 and 2), integrated on the exact active interval; relative accuracy about
 * 1e-6. */
weft_real weft_segment_reflectance(const weft_segment *segment, weft_vec3 light, weft_vec3 view);

/* Texture value at (x, y), |x| <= width/2, |y| <= length/2 (eq. 13 and 14); its mean over the rectangle is the
 * reflectance. */
weft_real weft_segment_texture(const weft_segment *segment, weft_real x, weft_real y, weft_vec3 light, weft_vec3 view);

/* ---- The same for many directions: what does not depend on them is computed once ---- */

/* What depends on umax. R(u) = scale e(u)^(-3/2), e(u) = cos^2 u + shape |shape| sin^2 u. */
typedef struct weft_spine {
    weft_real umax, sin_umax, cos_umax;
    weft_real shape; /* 1 + kappa (1 + cot umax): > 0 ellipse, 0 parabola, < 0 hyperbola */
    weft_real scale; /* (length/2 - width/2 sin umax) / sin umax * sqrt(e(umax)) */
} weft_spine;

typedef struct weft_prepared_segment {
    weft_segment segment;
    bool admissible, filament;
    weft_real cot_psi, inverse_sin_psi; /* cot psi, 1 / |sin psi|; staple only */
    weft_real phase_scale;              /* 1 / (2 pi exp(-|beta|) I0(beta)) */
    weft_real radius_share;             /* of umax where the spine that gives R ends: 1, or 1 - delta (frozen_radius) */
    weft_spine spine;
} weft_prepared_segment;

weft_prepared_segment weft_segment_prepare(const weft_segment *segment);

/* The spine of a segment with another umax. */
weft_spine weft_segment_spine(const weft_segment *segment, weft_real umax);

/* An angle of which the sine and the cosine are known: who steps through many angles turns them. */
typedef struct weft_angle {
    weft_real radians, sine, cosine;
} weft_angle;

/* G fc A as in weft_yarn_highlight. */
weft_real weft_prepared_integrand(const weft_prepared_segment *prepared, weft_angle coordinate, weft_vec3 light,
                                  weft_vec3 view);

/* weft_segment_reflectance and weft_segment_texture. `umax` replaces that of the segment and must leave it admissible.
 */
weft_real weft_prepared_reflectance(const weft_prepared_segment *prepared, weft_vec3 light, weft_vec3 view);
weft_real weft_prepared_texture(const weft_prepared_segment *prepared, weft_real umax, weft_real x, weft_real y,
                                weft_vec3 light, weft_vec3 view);

#endif
