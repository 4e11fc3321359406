#include "tests/btf/material/visibility_example.h"

#include "tests/btf/material/components_example.h"

#include <stdlib.h>

uint8_t visibility_example_cell(int i)
{
    return (uint8_t)(i * 7 % 5 < 3);
}

void visibility_write_example(const char *path)
{
    weft_material material;
    weft_material_visibility *visibility;
    components_write_example(path);
    if (weft_material_read(path, &material, NULL) != WEFT_OK ||
        weft_material_visibility_create(VISIBILITY_EXAMPLE_SIDE, material.level_count, &visibility, NULL) != WEFT_OK)
        abort();
    visibility->finer_levels = 2;
    visibility->coarser_levels = 1;
    for (int i = 0; i < (2 + material.level_count) * VISIBILITY_EXAMPLE_SIDE * VISIBILITY_EXAMPLE_SIDE; i++)
        visibility->cell[i] = visibility_example_cell(i);
    weft_material_take_visibility(&material, visibility);
    if (weft_material_write(path, &material, NULL) != WEFT_OK)
        abort();
    weft_material_free(&material);
}
