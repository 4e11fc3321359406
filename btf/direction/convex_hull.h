/* Convex hull of directions and the origin, in exact arithmetic. Used by btf/direction/triangulation.h. */
#ifndef WEFT_BTF_DIRECTION_CONVEX_HULL_H
#define WEFT_BTF_DIRECTION_CONVEX_HULL_H

#include "base/status.h"
#include "base/vector.h"

typedef struct weft_hull_face {
    int corner[3];    /* counter-clockwise seen from outside; index `count` stands for the origin */
    int neighbour[3]; /* face across the edge from corner[i] to corner[(i + 1) % 3] */
} weft_hull_face;

/* Hull of direction[0..count) and the origin (incremental, O(count^2)). The origin replaces the faces that would close
 * the hull of the directions from below; all other faces are those of the directions alone. Directions are rounded to
 * multiples of 2^-38 so that every predicate is exact: the result is a closed surface for any input, also where many
 * directions lie on one circle, and depends on the input alone. Directions within 1e-5 rad of an earlier one are left
 * out. *face_count is 0 where all directions lie on one great circle. *face is owned by the caller (free). Errors:
 * WEFT_SYSTEM for memory. Thread-safe. */
weft_code weft_convex_hull(const weft_vec3 *direction, int count, weft_hull_face **face, int *face_count,
                           weft_error *error);

#endif
