#include "player/mesh/mesh.h"

#include "base/real.h"

#include <math.h>
#include <string.h>

weft_code weft_mesh_plane(weft_mesh *mesh, weft_error *error)
{
    WEFT_TRY(weft_mesh_allocate(4, 2, mesh, error));
    for (int i = 0; i < 4; i++) {
        float u = (float)(i % 2), v = (float)(i / 2);
        mesh->vertex[i] = (weft_vertex){{u - 0.5f, v - 0.5f, 0}, {0, 0, 1}, {1, 0, 0, 1}, {u, v}};
    }
    weft_mesh_index_grid(mesh, 2, 2);
    return WEFT_OK;
}

/* Radius 1/2; u runs along the equator by arc length, v along the meridians. */
static weft_code make_sphere(weft_mesh *mesh, weft_error *error)
{
    enum { COLUMNS = 129, ROWS = 65 };
    const double radius = 0.5;
    WEFT_TRY(weft_mesh_allocate(COLUMNS * ROWS, 2 * (COLUMNS - 1) * (ROWS - 1), mesh, error));
    for (int row = 0; row < ROWS; row++) {
        for (int column = 0; column < COLUMNS; column++) {
            double longitude = 2 * WEFT_PI * column / (COLUMNS - 1), latitude = WEFT_PI * (row / (ROWS - 1.0) - 0.5);
            double x = cos(latitude) * cos(longitude), y = cos(latitude) * sin(longitude), z = sin(latitude);
            mesh->vertex[row * COLUMNS + column] = (weft_vertex){
                .position = {(float)(radius * x), (float)(radius * y), (float)(radius * z)},
                .normal = {(float)x, (float)y, (float)z},
                .tangent = {(float)-sin(longitude), (float)cos(longitude), 0, 1},
                .coordinate = {(float)(radius * longitude), (float)(radius * latitude)},
            };
        }
    }
    weft_mesh_index_grid(mesh, COLUMNS, ROWS);
    return WEFT_OK;
}

bool weft_mesh_is_built_in(const char *name)
{
    return strcmp(name, "plane") == 0 || strcmp(name, "sphere") == 0 || strcmp(name, "drape") == 0;
}

weft_code weft_mesh_open(const char *name, weft_mesh *mesh, weft_error *error)
{
    if (strcmp(name, "plane") == 0)
        return weft_mesh_plane(mesh, error);
    if (strcmp(name, "sphere") == 0)
        return make_sphere(mesh, error);
    if (strcmp(name, "drape") == 0)
        return weft_mesh_drape(mesh, error);
    return weft_mesh_read_obj(name, mesh, error);
}
