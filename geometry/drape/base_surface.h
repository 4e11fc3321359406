/* A surface that cloth is laid on, and where a place of the flat cloth comes to lie over it. */
#ifndef WEFT_GEOMETRY_DRAPE_BASE_SURFACE_H
#define WEFT_GEOMETRY_DRAPE_BASE_SURFACE_H

#include "base/status.h"
#include "base/vector.h"

#include <stdbool.h>
#include <stdint.h>

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

#endif
