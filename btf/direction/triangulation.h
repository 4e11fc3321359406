/* Spherical triangulation of a set of directions, and interpolation in it. */
#ifndef WEFT_BTF_DIRECTION_TRIANGULATION_H
#define WEFT_BTF_DIRECTION_TRIANGULATION_H

#include "base/status.h"
#include "base/vector.h"

/* Delaunay triangles of directions on the upper hemisphere: the faces of their convex hull that
 * do not close it from below, and the border edges of the patch. Immutable once built, so any
 * number of threads may look up in it. */
typedef struct weft_triangulation weft_triangulation;

/* Three stored directions and their weights (>= 0, sum 1). Unused entries: index -1, weight 0. */
typedef struct weft_barycentric {
    int index[3];
    weft_real weight[3];
} weft_barycentric;

/* Triangulates `count` directions (unit, any order; repeated ones are merged with the first).
 * "Repeated" is closer than 1e-5 rad. One direction gives a constant, two an arc, any number on one great circle (to
 * 1e-6) a chain of arcs. The caller owns *result and frees it with
 * weft_triangulation_free. Errors: WEFT_BAD_INPUT for count < 1, a direction that is not finite
 * or is zero; WEFT_SYSTEM for memory. */
weft_code weft_triangulation_build(const weft_vec3 *direction, int count, weft_triangulation **result,
                                   weft_error *error);
void weft_triangulation_free(weft_triangulation *triangulation);

/* Planar barycentric weights of the point where the ray along `query` (unit) meets its triangle;
 * outside all triangles, those of the nearest point of the border (by angle). Thread-safe. */
weft_barycentric weft_triangulation_lookup(const weft_triangulation *triangulation, weft_vec3 query);

/* Number of triangles, and the indices of their three corners ([count][3], owned by the
 * triangulation), for upload to a GPU. */
int weft_triangulation_triangle_count(const weft_triangulation *triangulation);
const int (*weft_triangulation_triangles(const weft_triangulation *triangulation))[3];

#endif
