/* Satin from one measurement under light along the normal (BARD: "basic anisotropic reflection distribution"; article
 * and corrections in docs/reference/models.md). A point (light, view) looks up the view that shows the same fibres when
 * the light stands on the normal, and scales what is seen there. Pure functions.
 */
#ifndef WEFT_REFLECTANCE_BARD_BARD_H
#define WEFT_REFLECTANCE_BARD_BARD_H

#include "btf/direction/triangulation.h"

typedef enum weft_bard_map {
    WEFT_BARD_IN_PLANE, /* the view turns in the plane of itself and the mirror ray's projection (section 3.2) */
    WEFT_BARD_PRINTED   /* eqs. 9 and 10 as printed: elevation and azimuth are scaled one by one */
} weft_bard_map;

/* Lights below this elevation are treated as if they stood at it, in the map and in the gain: both stay finite. */
#define WEFT_BARD_MIN_ELEVATION_DEG 3

typedef struct weft_bard_point {
    weft_real theta_light_rad;
    weft_real beta_rad, beta_o_rad; /* angle from the mirror ray's projection to view and direction; 0 for light along
                                       the normal, where there is no projection */
    weft_real gain;                 /* 1 / cos^2 theta_light (eq. 2), at most 365.1 */
    weft_vec3 direction;            /* where to look up, unit, on the upper side (the printed map may leave it) */
} weft_bard_point;

/* light and view unit and above the horizon. The in-plane map is continuous, keeps the horizon's points along the
 * projection, and sends the mirror direction to the normal. */
weft_bard_point weft_bard_locate(weft_bard_map map, weft_vec3 light, weft_vec3 view);

/* BRDF under light along the normal, 1/sr, for an outgoing direction. */
typedef weft_real weft_bard_lookup(const void *table, weft_vec3 direction);

/* rho_d / pi + gain * lookup(table, direction) in 1/sr; 0 where light or view is below the horizon (eq. 8). Neither
 * reciprocal nor energy conserving. */
weft_real weft_bard_brdf(weft_bard_map map, weft_real rho_d, weft_bard_lookup *lookup, const void *table,
                         weft_vec3 light, weft_vec3 view);

/* BRDF on a grid of angles: theta from 0 to 90 degrees inclusive, phi from 0 in equal steps round. */
typedef struct weft_bard_grid {
    int theta_count, phi_count; /* at least 2 and 1 */
    const weft_real *value;     /* [theta_count][phi_count] */
} weft_bard_grid;

/* A weft_bard_lookup in a weft_bard_grid: bilinear in the angles; directions below the horizon count as on it. */
weft_bard_lookup weft_bard_grid_lookup;

/* What a pair of directions takes from measured views: gain times the sum of weight times value. */
typedef struct weft_bard_mix {
    weft_real gain; /* 0 where light or view is below the horizon */
    weft_barycentric at;
} weft_bard_mix;

/* The lookup where the table is a set of views (any triangulation of them) instead of a grid. */
weft_bard_mix weft_bard_mix_views(weft_bard_map map, const weft_triangulation *views, weft_vec3 light, weft_vec3 view);

#endif
