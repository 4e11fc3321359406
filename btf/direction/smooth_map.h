/* Smooth maps: values at scattered directions become a square of nodes (square_map.h) that is as smooth as they allow.
 *
 * The nodes f minimise
 *
 *     sum_i w_i (B_i f - y_i)^2 + sum_j (B_j f)^2 + smoothness sum (f_xx^2 + 2 f_xy^2 + f_yy^2)
 *
 * with B_i the bilinear interpolation at place i, y_i the value there and w_i its weight, j the places where the map is
 * known to be 0, and the last sum over the second differences of the nodes: a thin plate (Duchon 1977) on a grid.
 * Between the samples the map bends as little as it can, where barycentric interpolation has a crease at every sample;
 * a highlight that lies between two lights is not cut off. Beyond the samples it goes on straight. */
#ifndef WEFT_BTF_DIRECTION_SMOOTH_MAP_H
#define WEFT_BTF_DIRECTION_SMOOTH_MAP_H

#include "base/status.h"
#include "btf/direction/square_map.h"

/* Factored once for all values at the same places. Immutable, so that any number of threads may solve with it. */
typedef struct weft_smooth_map weft_smooth_map;

typedef struct weft_smooth_map_places {
    int side;                /* nodes along a side, 4 .. 64 */
    double smoothness;       /* > 0 */
    const weft_place *place; /* [count] */
    const float *weight;     /* [count] > 0; NULL: 1 */
    int count;               /* >= 0; where there is no place at all the map is 0 */
    const weft_place *zero;  /* [zero_count] where the map is 0, or NULL */
    int zero_count;
} weft_smooth_map_places;

/* `places` is not kept. The caller frees. Errors: WEFT_BAD_USAGE for a side or smoothness out of range; WEFT_SYSTEM for
 * memory. */
weft_code weft_smooth_map_create(const weft_smooth_map_places *places, weft_smooth_map **result, weft_error *error);
void weft_smooth_map_free(weft_smooth_map *map);

/* The nodes for `series_count` sets of values: value [count][series_count], node [side * side][series_count]. The sets
 * do not influence each other. Thread-safe. Errors: WEFT_SYSTEM for memory. */
weft_code weft_smooth_map_solve(const weft_smooth_map *map, const float *value, int series_count, float *node,
                                weft_error *error);

/* How little the places tell of each node: its variance [side * side] where every value has the variance 1 / w_i, and
 * where the curvature weighs as the prior of a map that it is (Wahba 1983): the diagonal of the inverse of the
 * quadratic form. Thread-safe. Errors: WEFT_SYSTEM for memory. */
weft_code weft_smooth_map_variances(const weft_smooth_map *map, float *variance, weft_error *error);

#endif
