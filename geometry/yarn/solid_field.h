/* The implicit surface of a stitch: a field that is negative inside its yarns.
 *
 * Planes across the yarn through its stations cut space near it into slabs, so that a place meets each branch of a
 * yarn once. In the slab it has the coordinates q in the cross-section, 1 at the radius. With n plies,
 *     d(q) = min(radii) smin_k(|q - c_k| - rho_p),  rho_p = s / (1 + s),  s = sin(pi / n),
 * the c_k on a circle of radius 1 - rho_p that turns with the twist, and a core between them. Branches of one yarn are
 * joined by the same smooth minimum over `blend` mm (smin(a, b) = min(a, b) - max(blend - |a - b|, 0)^2 / (4 blend)),
 * different yarns by the plain minimum. Private to this folder; all functions are pure. */
#ifndef WEFT_GEOMETRY_YARN_SOLID_FIELD_H
#define WEFT_GEOMETRY_YARN_SOLID_FIELD_H

#include "geometry/stitch/segment_grid.h"

/* Value of the field where no yarn is near. */
#define WEFT_YARN_FIELD_FAR 1e9

/* The field at a place in the tile, about mm near the surface. */
weft_real weft_yarn_field_value(const weft_segment_grid *grid, weft_vec3 place_in_tile);

/* Unit gradient by central differences over +-`step`; any place. */
weft_vec3 weft_yarn_field_normal(const weft_segment_grid *grid, weft_vec3 place, weft_real step);

/* The yarn nearest to a place in the tile, and the direction of its fibres there: the velocity of the helix of plies
 * and, in the ply, of the helix of fibres. Index -1 where no yarn is near. */
int weft_yarn_field_fibre(const weft_segment_grid *grid, weft_vec3 place_in_tile, weft_vec3 *tangent);

#endif
