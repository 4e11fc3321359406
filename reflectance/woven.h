/* One yarn segment of woven cloth (Irawan and Marschner 2012, with the corrections of docs/models.md). Pure functions.
 * Segment frame: y along the yarn, z the surface normal, x = y cross z. GLSL twin: reflectance/woven.glsl. */
#ifndef WEFT_REFLECTANCE_WOVEN_H
#define WEFT_REFLECTANCE_WOVEN_H

#include "btf/vector.h"

#include <stdbool.h>

typedef struct weft_segment {
    weft_real alpha;  /* uniform scattering, >= 0 */
    weft_real beta;   /* concentration of forward scattering (von Mises) */
    weft_real delta;  /* fade length at the ends, 0..1; filament only */
    weft_real psi;    /* fibre twist, rad; 0 = filament, else staple */
    weft_real umax;   /* largest inclination of the spine, rad, 0 < umax <= pi/2 */
    weft_real kappa;  /* curvature of the spine, > -1 */
    weft_real width, length; /* of the segment rectangle, cells; width sin(umax) < length */
    weft_real highlight_width; /* of width or length, 0 < highlight_width <= 1 */
} weft_segment;

/* Whether such a segment exists. Every function below returns 0 for one that does not. */
bool weft_segment_admissible(const weft_segment *segment);

/* Radius of curvature R(u) of the spine at inclination u. */
weft_real weft_spine_radius(const weft_segment *segment, weft_real u);

/* Everything known at one point of the yarn. */
typedef struct weft_yarn_point {
    bool active;          /* whether the highlight exists here */
    weft_real solved;     /* v for staple, u for filament */
    weft_vec3 normal;
    weft_real radius;     /* R */
    weft_real geometry;   /* G */
    weft_real phase;      /* fc */
    weft_real attenuation;/* A */
    weft_real integrand;  /* G fc A, 0 where inactive */
} weft_yarn_point;

/* Staple: coordinate = u, solves v (eq. 3). Filament: coordinate = v, solves u (eq. 4). */
weft_yarn_point weft_yarn_highlight(const weft_segment *segment, weft_real coordinate, weft_vec3 light, weft_vec3 view);

/* alpha + exp(beta x) / (2 pi I0(beta)) with x = -light . view, evaluated without overflow (eq. 7). */
weft_real weft_phase_function(weft_real alpha, weft_real beta, weft_real x);

/* Reflectance of the whole segment (eq. 1 and 2), integrated on the exact active interval; relative accuracy about 1e-6. */
weft_real weft_segment_reflectance(const weft_segment *segment, weft_vec3 light, weft_vec3 view);

/* Texture value at (x, y), |x| <= width/2, |y| <= length/2 (eq. 13 and 14); its mean over the rectangle is the reflectance. */
weft_real weft_segment_texture(const weft_segment *segment, weft_real x, weft_real y, weft_vec3 light, weft_vec3 view);

#endif
