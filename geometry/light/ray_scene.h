/* What a ray meets in endless cloth: the triangles of a tile in Embree, repeated periodically in x and y.
 * Private to this folder. */
#ifndef WEFT_GEOMETRY_LIGHT_RAY_SCENE_H
#define WEFT_GEOMETRY_LIGHT_RAY_SCENE_H

#include "geometry/yarn/tile_mesh.h"

#include <stdbool.h>

typedef struct weft_ray_scene weft_ray_scene;

/* Where a ray met the cloth, in the coordinates of the tile. */
typedef struct weft_ray_hit {
    weft_vec3 at, normal; /* of the triangle, unit, outward */
    int triangle;
    weft_real weight[3]; /* of the vertices of the triangle, sum 1 */
    weft_real distance;  /* along the ray */
} weft_ray_hit;

/* Keeps a reference to `mesh`, which must stay. The caller frees with weft_ray_scene_free. Errors: WEFT_SYSTEM with the
 * text of Embree. */
weft_code weft_ray_scene_create(const weft_tile_mesh *mesh, weft_ray_scene **result, weft_error *error);
void weft_ray_scene_free(weft_ray_scene *scene);

/* The mesh of the scene. */
const weft_tile_mesh *weft_ray_scene_mesh(const weft_ray_scene *scene);

/* The nearest triangle along a ray from anywhere; false where it leaves the cloth. A triangle seen from inside counts,
 * its normal then points along the ray. Thread-safe. */
bool weft_ray_scene_trace(const weft_ray_scene *scene, weft_vec3 origin, weft_vec3 direction, weft_ray_hit *hit);

/* The middle of a triangle, as if a ray had met it there (distance 0). */
weft_ray_hit weft_ray_scene_middle(const weft_ray_scene *scene, int triangle);

/* lit[i] = 1 where the ray from `origin` toward light[i] leaves the cloth, for i with wanted[i] != 0; else 0. Shadow
 * rays travel in packets. Thread-safe. */
void weft_ray_scene_lit(const weft_ray_scene *scene, weft_vec3 origin, const weft_vec3 *light, int light_count,
                        const uint8_t *wanted, uint8_t *lit);

#endif
