/* The surface of a stitch as triangles: one tile, closed once its opposite borders are joined. */
#ifndef WEFT_GEOMETRY_YARN_TILE_MESH_H
#define WEFT_GEOMETRY_YARN_TILE_MESH_H

#include "geometry/stitch/stitch.h"

#include <stdint.h>

/* Owned by the caller, freed with weft_tile_mesh_free. Lengths in mm. Vertices on the border x = width or y = height
 * are those on the opposite border again, displaced by exactly one tile. */
typedef struct weft_tile_mesh {
    float width, height; /* of the tile: x in [0, width], y in [0, height] */
    float bottom, top;   /* least and greatest z of a vertex */
    float cell;          /* edge of the grid it was made on */
    int vertex_count, triangle_count;
    float (*position)[3];
    float (*normal)[3];      /* unit gradient of the implicit surface, outward */
    float (*tangent)[3];     /* unit direction of the fibres, perpendicular to the normal */
    int32_t *yarn;           /* index of the yarn of the stitch: its material */
    int32_t *original;       /* the vertex itself, or the one on the opposite border that it repeats */
    uint32_t (*triangle)[3]; /* anticlockwise seen from outside */
} weft_tile_mesh;

/* Polygonises the implicit surface of a stitch (geometry/yarn/solid_field.h) by marching cubes on a grid of
 * `resolution` cells across the width of the tile (0: that of the stitch). Deterministic for any number of threads.
 * `path` names the stitch in messages. Errors: WEFT_BAD_INPUT for a grid too large, WEFT_SYSTEM. */
weft_code weft_tile_mesh_create(const weft_stitch *stitch, int resolution, const char *path, weft_tile_mesh *mesh,
                                weft_error *error);
void weft_tile_mesh_free(weft_tile_mesh *mesh);

/* Writes `tiles_x` x `tiles_y` copies of the tile as a Wavefront OBJ file with normals, atomically; one unit is one mm.
 * Texture coordinates are in tiles. Errors: WEFT_SYSTEM. */
weft_code weft_tile_mesh_write_obj(const char *path, const weft_tile_mesh *mesh, int tiles_x, int tiles_y,
                                   weft_error *error);

#endif
