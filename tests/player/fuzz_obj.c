/* Mutated OBJ files: refused with a message, or a mesh whose numbers are finite and whose indices are its own. */
#include "player/mesh/mesh.h"
#include "tests/support/fuzz.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char seed[] = "# a box without a lid\nmtllib box.mtl\no box\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n"
                           "v 1 0 1e0\nvt 0 0\nvt 1 0\nvt 1.5 1\nvt 0.25 1\nvt 0.5\nvn 0 0 1\nvn 0 -2 0\ns off\n"
                           "f 1/1/1 2/2/1 3/3/1 4/4/1\nf 1/1/2 5/4 6/3 -5/5/-1\nf 1/1 3/3 -1/5\n";

void fuzz_write_seed(const char *path)
{
    FILE *file = fopen(path, "wb");
    if (!file || fputs(seed, file) < 0 || fclose(file) != 0)
        abort();
}

static void check_vertex(const weft_vertex *vertex)
{
    const float *number = (const float *)vertex;
    for (size_t i = 0; i < sizeof *vertex / sizeof(float); i++)
        if (!isfinite(number[i]))
            abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    weft_mesh mesh;
    weft_error error = {0};
    weft_code code = weft_mesh_read_obj(fuzz_file(bytes, size), &mesh, &error);
    if (code != WEFT_OK) {
        if (error.code != code || !error.message[0])
            abort();
        return 0;
    }
    for (int i = 0; i < mesh.vertex_count; i++)
        check_vertex(&mesh.vertex[i]);
    for (int t = 0; t < mesh.triangle_count; t++)
        for (int i = 0; i < 3; i++)
            if (mesh.index[t][i] >= (uint32_t)mesh.vertex_count)
                abort();
    if (!isfinite(mesh.size) || !isfinite(mesh.coordinate_length))
        abort();
    weft_mesh_free(&mesh);
    return 0;
}
