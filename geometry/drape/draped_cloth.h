/* Cloth of any shape as it is: the geometry of a stitch instanced over a surface, and the light in it, traced. What a
 * material made of the stitch, laid over the same surface, ought to look like.
 *
 * A path starts where a ray of the camera meets the cloth and goes on by the cosine of the normal, as in
 * geometry/light/illumination.h; every vertex looks for the light with a ray. */
#ifndef WEFT_GEOMETRY_DRAPE_DRAPED_CLOTH_H
#define WEFT_GEOMETRY_DRAPE_DRAPED_CLOTH_H

#include "base/status.h"
#include "base/vector.h"
#include "geometry/yarn/tile_mesh.h"

#include <stdbool.h>
#include <stdint.h>

/* ---- The surface that cloth is laid on, and where a place of the flat cloth comes to lie over it ---- */

typedef struct weft_base_vertex {
    weft_vec3 position, normal; /* mm; unit */
    weft_real x, y;             /* the place of the flat cloth that lies here, mm */
} weft_base_vertex;

/* Triangles, anticlockwise seen from the side of the normals and on the flat cloth. Borrowed arrays. */
typedef struct weft_base_surface {
    int vertex_count, triangle_count;
    const weft_base_vertex *vertex; /* [vertex_count] */
    const uint32_t (*triangle)[3];  /* [triangle_count] */
    weft_real plane_mm;             /* what of the flat cloth lies on it: this height above its top face */
} weft_base_surface;

/* Finds the triangle over which a place of the flat cloth lies. */
typedef struct weft_base_map {
    const weft_base_surface *surface;       /* not owned */
    weft_real low_x, low_y, high_x, high_y; /* of the flat cloth, mm */
    int columns, rows;                      /* of buckets */
    int *start;                             /* [columns * rows + 1] */
    int *triangle;                          /* [start of the end], those that touch a bucket */
} weft_base_map;

/* A place of the surface with the frame into which the flat cloth's is turned: the surface's derivatives along x and y,
 * and the interpolated normal. */
typedef struct weft_base_place {
    weft_vec3 at, along_x, along_y, normal;
} weft_base_place;

/* The caller frees with weft_base_map_free. Errors: WEFT_BAD_INPUT for a triangle that is mirrored or of no area,
 * WEFT_SYSTEM. */
weft_code weft_base_map_create(const weft_base_surface *surface, weft_base_map *map, weft_error *error);
void weft_base_map_free(weft_base_map *map);

/* False where (x, y) lies beside the surface. Where triangles overlap on the flat cloth, the first counts. Pure. */
bool weft_base_map_find(const weft_base_map *map, weft_real x, weft_real y, weft_base_place *place);

/* ---- The cloth on it ---- */

typedef struct weft_draped_cloth weft_draped_cloth;

enum { WEFT_DRAPED_MAX_TRIANGLES = 1 << 24 };

/* Maps every tile through the surface, on it the plane on which an acquisition places its texels: vertex (x, y, z)
 * comes to lie at P(x, y) + (z - top - plane_mm) N(x, y), with interpolated positions P and normals N. Tiles begin at
 * (0, 0) of the flat cloth and are cut at its hem. Keeps references to stitch and mesh, which must stay, none to the
 * surface. The caller frees with weft_draped_cloth_free. Errors: WEFT_BAD_INPUT for more than WEFT_DRAPED_MAX_TRIANGLES
 * triangles or a surface that is mirrored somewhere; WEFT_SYSTEM. */
weft_code weft_draped_cloth_create(const weft_stitch *stitch, const weft_tile_mesh *mesh,
                                   const weft_base_surface *surface, weft_draped_cloth **result, weft_error *error);
void weft_draped_cloth_free(weft_draped_cloth *cloth);

int weft_draped_cloth_triangle_count(const weft_draped_cloth *cloth);

/* A distant light whose irradiance across its direction is pi, and how it is followed. */
typedef struct weft_draped_light {
    weft_vec3 direction; /* unit, toward the light */
    int bounces;         /* 0: direct light only */
    weft_real reach_mm;  /* of `near` below */
} weft_draped_light;

/* Radiance toward the camera: of all light; and of what cloth within reach hinders and sends back alone, which leaves
 * out what distant parts of the cloth do to each other. */
typedef struct weft_draped_radiance {
    float all[3], near[3];
} weft_draped_radiance;

/* Follows path `index` of the sequence `key` from the ray that leaves `origin` along the unit vector `direction`; adds
 * to *radiance. False where the ray meets no cloth; yarns cut open at a hem are black inside. Thread-safe; the same
 * arguments give the same numbers. */
bool weft_draped_cloth_path(const weft_draped_cloth *cloth, weft_vec3 origin, weft_vec3 direction,
                            const weft_draped_light *light, uint64_t key, uint32_t index,
                            weft_draped_radiance *radiance);

#endif
