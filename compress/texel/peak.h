/* How bright a texel can be anywhere on the hemisphere: a bound that is computed, not found by trying directions.
 *
 * Bounded are f(l, v) = S(l) T(v) (rho + sum_i A_i max(0, l . w_i)^N_i), w_i = M_i v (compress/fit/gram.h), and
 * r = f cos(theta_light), for all l and v above the horizon.
 *
 * One view. The largest cos(theta_light) (l . w)^N is |w|^N cos(t)^N cos(alpha - t), alpha being the angle of w from
 * the normal and N tan(t) = tan(alpha - t), a quadratic equation in tan(t). With S there is no such form: how bright a
 * lobe that points to u can become is then sought for a grid of u once for each lobe, over a grid of lights. It is
 * convex and homogeneous of degree N in u, so that what lies between the corners of the grid is at most their mean by
 * its place in the plane that they span.
 *
 * Between views. l . w is linear in v. So the largest (l . w)^N is convex and homogeneous of degree N in v: inside a
 * spherical triangle it is at most s^N times the largest at its corners, where 1 / s is the distance of their plane
 * from the origin. T, as a reader interpolates it, is at most its largest at the corners. Triangles are small, so that
 * s^N is near 1 for all but the sharpest lobes; for those M_i has no value above 1. */
#ifndef WEFT_COMPRESS_TEXEL_PEAK_H
#define WEFT_COMPRESS_TEXEL_PEAK_H

#include "btf/direction/triangulation.h"
#include "compress/fit/fit.h"

/* Directions of lobes are the corners of an octahedron's faces, divided and folded open into a square (Cigolle et al.
 * 2014: x and y over |x| + |y| + |z|, the lower half turned outwards); lights, those of the material and rings between
 * them. */
enum {
    WEFT_PEAK_RINGS = 13,
    WEFT_PEAK_RING = 36,
    WEFT_PEAK_CELLS = 32,
    WEFT_PEAK_AIMS = (WEFT_PEAK_CELLS + 1) * (WEFT_PEAK_CELLS + 1)
};

/* S of a texel on the grid of lights, and room for one lobe. For one thread. */
typedef struct weft_peak_lights {
    int count, stride;
    weft_barycentric *at;     /* [count] where a reader finds S */
    weft_barycentric *aim_at; /* [AIMS] the same for a light that stands where a lobe points to; index -1 below */
    float *z, *aim_z;         /* [count], [AIMS] cosines */
    float *log_length;        /* [AIMS] log2 of the distance of the face from the origin there */
    float *log_cosine;        /* [AIMS][stride] log2 u . l */
    float *log_r, *log_f;     /* [stride] log2 S cos(theta) and S */
    float *own_r, *own_f;     /* [AIMS] the same for a light that stands there */
    float *aim_r, *aim_f;     /* [AIMS] log2 of what a lobe has that points there, on the face */
    double most_r, most_f;    /* log2 of the largest there is */
} weft_peak_lights;

/* Small triangles that cover the views above the horizon, and room for what one texel has there. For one thread. */
typedef struct weft_peak_net {
    int view_count, corner_count, corner_stride, triangle_count, triangle_stride;
    bool follows_table;   /* T is taken corner by corner; else it is at most its largest everywhere */
    weft_barycentric *at; /* [corner_count] where a reader finds T */
    float *xyz[3];        /* [corner_stride] */
    int32_t *corner[3];   /* [triangle_stride]; the first corner in the padding */
    float *log_growth;    /* [triangle_stride] log2 s */
    float *log_r, *log_f; /* [corner_stride] log2 of the largest value of one lobe, with the cosine and without */
    float *sum_r, *sum_f; /* [triangle_stride] of all terms, without T */
    float *table;         /* [corner_stride] T */
    double slack;
} weft_peak_net;

typedef struct weft_peak {
    double r, f; /* with the cosine and without */
} weft_peak;

typedef struct weft_peak_tables {
    const double *view;      /* [view_count] T as it will be read; NULL: 1 */
    weft_peak_lights *light; /* S; NULL: 1 */
} weft_peak_tables;

/* The grid for the lights of a material. Errors: those of weft_peak_net_create. */
weft_code weft_peak_lights_create(const weft_vec3 *light, int light_count, weft_peak_lights *lights, weft_error *error);
void weft_peak_lights_free(weft_peak_lights *lights);

/* Takes S as it will be read, [light_count]. */
void weft_peak_lights_set(weft_peak_lights *lights, const double *s);

/* A net over the views of a material as a reader interpolates between them. Triangles are divided until the edges of
 * each are at most `widest_rad`. Errors: WEFT_SYSTEM for memory, WEFT_BAD_INPUT for directions that cannot be
 * triangulated. */
weft_code weft_peak_net_create(const weft_vec3 *view, int view_count, double widest_rad, weft_peak_net *net,
                               weft_error *error);
void weft_peak_net_free(weft_peak_net *net);

/* No value of `fit` exceeds this, in the units of its amplitudes. */
weft_peak weft_peak_of_fit(weft_peak_net *net, const weft_fit *fit, const weft_peak_tables *tables);

/* Right after weft_peak_of_fit with the same arguments: by what T of every view must be multiplied so that nothing
 * exceeds `most`; factor [view_count], 1 where nothing needs to change. */
void weft_peak_factors(const weft_peak_net *net, weft_peak most, double *factor);

#endif
