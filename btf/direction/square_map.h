/* Hemispheres on a square: places of directions, and bilinear interpolation between the nodes of the square. A GPU does
 * the same by hardware, where barycentric interpolation between scattered directions takes many reads. All functions
 * are pure. GLSL twin: reflectance/components/components.glsl. */
#ifndef WEFT_BTF_DIRECTION_SQUARE_MAP_H
#define WEFT_BTF_DIRECTION_SQUARE_MAP_H

#include "base/vector.h"

/* A point of the unit square. */
typedef struct weft_place {
    weft_real x, y;
} weft_place;

/* Paraboloid map (Heidrich and Seidel 1998) of a unit direction with z >= 0:
 *     (1/2, 1/2) + (x, y) / (2 (1 + z)).
 * The hemisphere fills the disc that touches the sides of the square. */
weft_place weft_place_of_direction(weft_vec3 direction);

/* Concentric map (Shirley and Chiu 1997), of equal area, of a unit half vector with z >= 0. With the radius r = sqrt(1
 * - z) and the azimuth phi, the sides of the square are those of constant r; a quarter of the disc fills a quarter of
 * the square. It spends more nodes near the normal than the paraboloid does. */
weft_place weft_place_of_half_vector(weft_vec3 half_vector);

/* Their inverses. The corners of the square, outside the disc of the paraboloid, are unit directions below the horizon.
 */
weft_vec3 weft_direction_of_place(weft_place place);
weft_vec3 weft_half_vector_of_place(weft_place place);

/* The four nodes around a place and their weights, which sum to 1. Node (i, j) of a square of side x side nodes lies at
 * (i, j) / (side - 1) and has the index j side + i. Places outside the square count as the nearest on its border. side
 * >= 2. */
typedef struct weft_square_cell {
    int index[4];
    weft_real weight[4];
} weft_square_cell;

weft_square_cell weft_square_cell_at(weft_place place, int side);

#endif
