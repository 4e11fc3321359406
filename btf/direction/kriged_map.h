/* Kriging on a square of nodes (square_map.h; Rasmussen and Williams 2006): values at scattered places become values at
 * the nodes, those of the least expected squared error where the values are what bilinear interpolation between the
 * nodes gives, plus noise, and where the nodes at directions a and b have the covariance
 *
 *     C(a, b) = M(|a - b| / length) + trend (1 + a . b),   M(x) = (1 + sqrt(3) x) exp(-sqrt(3) x)   (Matern, 3/2)
 *
 * So a map is exact at its places where there is no noise, however coarse the square. Far from them it returns to 0;
 * where it is `ordinary`, to the mean of the values, which is unknown then; with a trend, slowly to a plane. */
#ifndef WEFT_BTF_DIRECTION_KRIGED_MAP_H
#define WEFT_BTF_DIRECTION_KRIGED_MAP_H

#include "base/status.h"
#include "btf/direction/square_map.h"

#include <stdbool.h>

/* The covariances of the nodes with each other. Immutable; freed with weft_kriged_grid_free. */
typedef struct weft_kriged_grid {
    int side, node_count;
    double *covariance; /* [node][node] */
} weft_kriged_grid;

/* Of the square of directions, or of half vectors. Errors: WEFT_SYSTEM. */
weft_code weft_kriged_grid_create(int side, bool of_half_vectors, float length, float trend, weft_kriged_grid *grid,
                                  weft_error *error);
void weft_kriged_grid_free(weft_kriged_grid *grid);

typedef struct weft_kriged_places {
    const weft_kriged_grid *grid;
    const weft_place *place; /* [count] */
    const float *noise;      /* [count] its variance, beside the nugget, or NULL: 0 */
    int count;               /* >= 1 */
    float nugget;            /* > 0 */
    bool ordinary;
} weft_kriged_places;

/* Factored once for all values at the same places. Immutable, so that any number of threads may solve with it. */
typedef struct weft_kriged_map weft_kriged_map;

/* Copies the places, but not the grid. The caller frees. Errors: WEFT_BAD_INPUT for numbers that are none;
 * WEFT_SYSTEM. */
weft_code weft_kriged_map_create(const weft_kriged_places *places, weft_kriged_map **result, weft_error *error);
void weft_kriged_map_free(weft_kriged_map *map);

/* The nodes for `series` sets of values: value [count][series], node [node][series]. The sets do not influence each
 * other. Thread-safe. Errors: WEFT_SYSTEM. */
weft_code weft_kriged_map_solve(const weft_kriged_map *map, const float *value, int series, float *node,
                                weft_error *error);

/* The expected squared error of each node, as a share of the variance of M: variance [node]. It depends on where the
 * places are, not on values. Thread-safe. Errors: WEFT_SYSTEM. */
weft_code weft_kriged_map_variances(const weft_kriged_map *map, float *variance, weft_error *error);

/* Each value minus what the others predict in its place (Dubrule 1983): residual [count][series]. Thread-safe. Errors:
 * WEFT_SYSTEM. */
weft_code weft_kriged_map_leave_out(const weft_kriged_map *map, const float *value, int series, float *residual,
                                    weft_error *error);

#endif
