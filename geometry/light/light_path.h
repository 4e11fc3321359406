/* Paths of light through endless cloth, from the camera on (Kajiya 1986). Private to this folder. */
#ifndef WEFT_GEOMETRY_LIGHT_LIGHT_PATH_H
#define WEFT_GEOMETRY_LIGHT_LIGHT_PATH_H

#include "geometry/light/ray_scene.h"
#include "geometry/yarn/fibre.h"
#include "geometry/yarn/tile_mesh.h"

#include <stdbool.h>

/* Where paths run; not owned. */
typedef struct weft_path_scene {
    const weft_stitch *stitch;
    weft_ray_scene *rays;
} weft_path_scene;

/* How a path went on from a vertex. */
typedef enum weft_path_end {
    WEFT_PATH_GOES_ON, /* to another vertex */
    WEFT_PATH_LEFT,    /* the cloth */
    WEFT_PATH_LOST     /* it carries nothing any more, or slipped inside a yarn through a crease */
} weft_path_end;

typedef struct weft_path_vertex {
    weft_ray_hit hit;
    weft_vec3 tangent;
    int yarn;
    weft_fibre_view seen; /* from where the path came */
} weft_path_vertex;

/* The first vertex: what the ray meets that passes through `place` and ends at the cloth, the camera lying toward
 * `view`. False where it meets no cloth. Thread-safe. */
bool weft_path_begin(const weft_path_scene *scene, weft_vec3 place, weft_vec3 view, weft_path_vertex *vertex);

/* Moves to the next vertex, by a direction drawn with the cosine of the normal: point `index` of the sequence `key`.
 * Multiplies `throughput` by pi BRDF. Thread-safe. */
weft_path_end weft_path_bounce(const weft_path_scene *scene, weft_path_vertex *vertex, weft_rgb *throughput,
                               uint64_t key, uint32_t index);

/* The point from which rays leave a place of the surface. Pure. */
weft_vec3 weft_path_above(const weft_path_scene *scene, weft_vec3 at, weft_vec3 normal);

/* The normal of the smooth surface at a vertex: that of the triangle is in its hit. Pure. */
weft_vec3 weft_path_surface_normal(const weft_path_scene *scene, const weft_path_vertex *vertex);

/* ---- Steps that do not depend on where rays are traced ---- */

/* Where a ray that leaves the surface at a place starts, so that it does not meet it again. */
weft_vec3 weft_path_ray_start(const weft_tile_mesh *mesh, weft_vec3 at, weft_vec3 normal);

/* A direction whose density is the cosine to the normal over pi, from a point of [0, 1)^2; `tangent` is unit and
 * perpendicular to the normal. */
weft_vec3 weft_path_cosine_direction(weft_vec3 normal, weft_vec3 tangent, const double point[2]);

/* Carries throughput over a reflection into such a direction: times f pi. False where hardly anything is left. */
bool weft_path_reflect(weft_rgb f, weft_rgb *throughput);

#endif
