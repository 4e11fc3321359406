/* Triangle meshes to hang a material on. The world has z up and no unit; the built-in shapes are about one unit large,
 * and one unit of their texture coordinates is one unit of length. */
#ifndef WEFT_PLAYER_MESH_MESH_H
#define WEFT_PLAYER_MESH_MESH_H

#include "base/status.h"

#include <stdbool.h>
#include <stdint.h>

/* As it is uploaded. tangent[0..2] points along increasing u; tangent[3] is +1 where normal x tangent points along
 * increasing v, -1 where the texture is mirrored. */
typedef struct weft_vertex {
    float position[3], normal[3], tangent[4], coordinate[2];
} weft_vertex;

/* Triangles run counter-clockwise seen from the side of the normal. Owned arrays. */
typedef struct weft_mesh {
    int vertex_count, triangle_count;
    int coarse_count;     /* triangles between every other vertex, for small pictures; 0: there are none */
    weft_vertex *vertex;  /* [vertex_count] */
    uint32_t (*index)[3]; /* [triangle_count + coarse_count] */
    double size;          /* side of the plane or of the cloth, diameter of the sphere, longest side of a file's box */
    double coordinate_length; /* of the surface for one unit of texture coordinates */
} weft_mesh;

enum { WEFT_MESH_MAX_VERTICES = 1 << 26, WEFT_MESH_MAX_TRIANGLES = 1 << 26 };

/* Zeroed arrays, with room for a quarter as many coarse triangles; both lengths 1. Errors: WEFT_BAD_USAGE for counts
 * out of range, WEFT_SYSTEM. */
weft_code weft_mesh_allocate(int vertex_count, int triangle_count, weft_mesh *mesh, weft_error *error);
void weft_mesh_free(weft_mesh *mesh);

/* Centre of the bounding box and the distance from it to the farthest vertex. Pure. */
void weft_mesh_bounds(const weft_mesh *mesh, float centre[3], float *radius);

/* Unit normals from the triangles, weighted by area; vertices with equal `group` [vertex_count] share theirs (NULL:
 * every vertex by itself). A vertex of no area gets z. Errors: WEFT_SYSTEM. */
weft_code weft_mesh_compute_normals(weft_mesh *mesh, const uint32_t *group, weft_error *error);

/* Unit tangents across the normals from positions and texture coordinates (Lengyel 2001; Debian has no library for it);
 * any perpendicular where the coordinates are degenerate. Errors: WEFT_SYSTEM. */
weft_code weft_mesh_compute_tangents(weft_mesh *mesh, weft_error *error);

/* Two triangles for each cell of a grid of columns x rows vertices, row-major, and where both are odd two coarse ones
 * for every four cells; the mesh has room for them. */
void weft_mesh_index_grid(weft_mesh *mesh, int columns, int rows);

/* ---- Built in. The caller frees with weft_mesh_free. Errors: WEFT_SYSTEM. ---- */

/* The square [-1/2, 1/2]^2 in z = 0, u along x, v along y. */
weft_code weft_mesh_plane(weft_mesh *mesh, weft_error *error);

/* A square cloth of side 1 laid over a round table and left to hang, simulated by position-based dynamics (Mueller et
 * al. 2007) with small steps. Texture coordinates are lengths on the cloth. The same on every call. */
weft_code weft_mesh_drape(weft_mesh *mesh, weft_error *error);

/* ---- Files ---- */

/* Reads Wavefront OBJ: v, vt, vn, f (polygons become fans), with y up turned to z up; other statements are skipped.
 * Normals are computed where a face has none. The caller frees with weft_mesh_free. Errors: WEFT_BAD_INPUT "FILE:LINE:
 * ..." for an index out of range, a number that is not finite, no faces, no texture coordinates, or over the limits
 * above. */
weft_code weft_mesh_read_obj(const char *path, weft_mesh *mesh, weft_error *error);

/* Sets both lengths from the vertices: the longest side of the bounding box, and the square root of the area on the
 * mesh over that on the texture (0 where the texture has none). */
void weft_mesh_measure(weft_mesh *mesh);

/* Whether the name is one of "drape", "sphere", "plane". Pure. */
bool weft_mesh_is_built_in(const char *name);

/* "drape", "sphere", "plane", or the path of an OBJ file. */
weft_code weft_mesh_open(const char *name, weft_mesh *mesh, weft_error *error);

#endif
