#include "player/mesh/mesh.h"

#include "base/real.h"

#include <math.h>
#include <string.h>

/* Two triangles for each square of stride x stride cells. Returns the end of them. */
static uint32_t (*index_squares(uint32_t (*index)[3], int columns, int rows, int stride))[3]
{
    for (int row = 0; row + stride < rows; row += stride) {
        for (int column = 0; column + stride < columns; column += stride) {
            uint32_t a = (uint32_t)(row * columns + column), b = a + (uint32_t)stride;
            uint32_t c = a + (uint32_t)(stride * columns), d = c + (uint32_t)stride;
            memcpy(*index++, (uint32_t[3]){a, b, d}, sizeof *index);
            memcpy(*index++, (uint32_t[3]){a, d, c}, sizeof *index);
        }
    }
    return index;
}

void weft_mesh_index_grid(weft_mesh *mesh, int columns, int rows)
{
    uint32_t(*fine_end)[3] = index_squares(mesh->index, columns, rows, 1);
    if (columns % 2 == 1 && rows % 2 == 1)
        mesh->coarse_count = (int)(index_squares(fine_end, columns, rows, 2) - fine_end);
}

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

weft_code weft_mesh_sphere(weft_mesh *mesh, weft_error *error)
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
        return weft_mesh_sphere(mesh, error);
    if (strcmp(name, "drape") == 0)
        return weft_mesh_drape(mesh, error);
    return weft_mesh_read_obj(name, mesh, error);
}
