/* The triangles of a stitch, tile by tile, laid over a surface, and what a ray meets there. Private to the room. */
#ifndef WEFT_GEOMETRY_DRAPE_DRAPED_SCENE_H
#define WEFT_GEOMETRY_DRAPE_DRAPED_SCENE_H

#include "geometry/drape/base_surface.h"
#include "geometry/yarn/tile_mesh.h"

#include <stdbool.h>

typedef struct weft_draped_scene weft_draped_scene;

/* Where a ray met the cloth. Lengths in mm. */
typedef struct weft_draped_hit {
    weft_vec3 at, normal, tangent; /* normal of the triangle, outward; direction of the fibres across it; unit */
    int yarn;
    weft_real distance; /* along the ray */
} weft_draped_hit;

/* The surface carries the top of the cloth, or a plane in it: a vertex at height z of the tile lies top + plane_mm - z
 * below it along the normal. Tiles begin at (0, 0) of the flat cloth; triangles that reach beyond the hem are left out.
 * Keeps a reference to `mesh`, which must stay. The caller frees with weft_draped_scene_free. Errors: WEFT_BAD_INPUT
 * for more than `most` triangles or a surface that weft_base_map_create refuses, WEFT_SYSTEM with the text of Embree.
 */
weft_code weft_draped_scene_create(const weft_tile_mesh *mesh, const weft_base_surface *surface, int most,
                                   weft_draped_scene **result, weft_error *error);
void weft_draped_scene_free(weft_draped_scene *scene);

int weft_draped_scene_triangle_count(const weft_draped_scene *scene);

/* The nearest triangle along a unit direction, from the inside, too; false where there is none. Thread-safe. */
bool weft_draped_scene_trace(const weft_draped_scene *scene, weft_vec3 origin, weft_vec3 direction,
                             weft_draped_hit *hit);

/* How far it is to the nearest triangle; INFINITY where there is none. Thread-safe. */
weft_real weft_draped_scene_distance(const weft_draped_scene *scene, weft_vec3 origin, weft_vec3 direction);

#endif
