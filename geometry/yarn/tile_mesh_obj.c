#include "base/atomic_file.h"
#include "geometry/yarn/tile_mesh.h"

#include <stdio.h>
#include <stdlib.h>

static void print_vertices(FILE *file, const weft_tile_mesh *mesh, int tile_x, int tile_y)
{
    for (int i = 0; i < mesh->vertex_count; i++) {
        const float *at = mesh->position[i], *normal = mesh->normal[i];
        double x = (double)at[0] + tile_x * (double)mesh->width, y = (double)at[1] + tile_y * (double)mesh->height;
        fprintf(file, "v %.6g %.6g %.6g\nvt %.6g %.6g\nvn %.4f %.4f %.4f\n", x, y, (double)at[2],
                x / (double)mesh->width, y / (double)mesh->height, (double)normal[0], (double)normal[1],
                (double)normal[2]);
    }
}

static void print_triangles(FILE *file, const weft_tile_mesh *mesh, unsigned long long first)
{
    for (int i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangle[i];
        unsigned long long a = first + t[0], b = first + t[1], c = first + t[2];
        fprintf(file, "f %llu/%llu/%llu %llu/%llu/%llu %llu/%llu/%llu\n", a, a, a, b, b, b, c, c, c);
    }
}

static void print_tiles(FILE *file, const weft_tile_mesh *mesh, int tiles_x, int tiles_y)
{
    unsigned long long first = 1;
    for (int y = 0; y < tiles_y; y++) {
        for (int x = 0; x < tiles_x; x++) {
            print_vertices(file, mesh, x, y);
            print_triangles(file, mesh, first);
            first += (unsigned long long)mesh->vertex_count;
        }
    }
}

weft_code weft_tile_mesh_write_obj(const char *path, const weft_tile_mesh *mesh, int tiles_x, int tiles_y,
                                   weft_error *error)
{
    weft_atomic_file target;
    WEFT_TRY(weft_atomic_file_begin(path, &target, error));
    FILE *file = fopen(target.temporary_path, "wb");
    if (!file) {
        weft_code code = weft_fail_errno(error, "write", path);
        weft_atomic_file_abandon(&target);
        return code;
    }
    print_tiles(file, mesh, tiles_x, tiles_y);
    int failed = ferror(file);
    if (fclose(file) != 0 || failed) {
        weft_code code = weft_fail_errno(error, "write", path);
        weft_atomic_file_abandon(&target);
        return code;
    }
    return weft_atomic_file_commit(&target, error);
}
