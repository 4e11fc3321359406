/* Paths of light through endless cloth, from the camera on (Kajiya 1986). Private to the room. */
#ifndef WEFT_GEOMETRY_LIGHT_PATH_H
#define WEFT_GEOMETRY_LIGHT_PATH_H

#include "geometry/light/ray_scene.h"
#include "geometry/yarn/fibre.h"

/* Where paths run; not owned. */
typedef struct path_scene {
    const weft_stitch *stitch;
    ray_scene *rays;
} path_scene;

/* How a path went on from a vertex. */
typedef enum path_end {
    PATH_GOES_ON, /* to another vertex */
    PATH_LEFT,    /* the cloth */
    PATH_LOST     /* it carries nothing any more, or slipped inside a yarn through a crease */
} path_end;

typedef struct path_vertex {
    ray_hit hit;
    weft_vec3 tangent;
    int yarn;
    weft_fibre_view seen; /* from where the path came */
} path_vertex;

/* The first vertex: what the ray meets that passes through `place` and ends at the cloth, the camera lying toward
 * `view`. False where it meets no cloth. Thread-safe. */
bool path_begin(const path_scene *scene, weft_vec3 place, weft_vec3 view, path_vertex *vertex);

/* Moves to the next vertex, by a direction drawn with the cosine of the normal: point `index` of the sequence `key`.
 * Multiplies `throughput` by pi BRDF. Thread-safe. */
path_end path_bounce(const path_scene *scene, path_vertex *vertex, weft_rgb *throughput, uint64_t key, uint32_t index);

/* The point from which rays leave a place of the surface. Pure. */
weft_vec3 path_above(const path_scene *scene, weft_vec3 at, weft_vec3 normal);

/* The normal of the smooth surface at a vertex: that of the triangle is in its hit. Pure. */
weft_vec3 path_surface_normal(const path_scene *scene, const path_vertex *vertex);

#endif
