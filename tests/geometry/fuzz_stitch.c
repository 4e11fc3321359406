/* Mutated stitch files: refused with a message, or made into a mesh whose numbers are finite. */
#include "geometry/yarn/tile_mesh.h"
#include "tests/geometry/stitch_text.h"
#include "tests/support/fuzz.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void fuzz_write_seed(const char *path)
{
    FILE *file = fopen(path, "wb");
    if (!file || fputs(STITCH_TEXT, file) < 0 || fclose(file) != 0)
        abort();
}

static void check_refusal(weft_code code, const weft_error *error)
{
    if (error->code != code || strncmp(error->message, "fuzz.stitch:", 12) != 0)
        abort();
}

static void check_finite(const weft_tile_mesh *mesh)
{
    for (int i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++)
            if (!isfinite(mesh->position[i][k]) || !isfinite(mesh->normal[i][k]) || !isfinite(mesh->tangent[i][k]))
                abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    char *text = malloc(size + 1);
    weft_stitch stitch;
    weft_tile_mesh mesh;
    weft_error error = {0};
    if (!text)
        abort();
    memcpy(text, bytes, size);
    text[size] = '\0';
    weft_code code = weft_stitch_parse(text, "fuzz.stitch", &stitch, &error);
    if (code != WEFT_OK) {
        check_refusal(code, &error);
    } else {
        code = weft_tile_mesh_create(&stitch, 16, "fuzz.stitch", &mesh, &error);
        if (code != WEFT_OK) {
            check_refusal(code, &error);
        } else {
            check_finite(&mesh);
            weft_tile_mesh_free(&mesh);
        }
        weft_stitch_free(&stitch);
    }
    free(text);
    return 0;
}
