#include "tests/btf/material/seen_example.h"

#include "tests/btf/material/components_example.h"

#include <stdlib.h>

uint8_t seen_example_cell(int i)
{
    return (uint8_t)(i * 7 % 5 < 3);
}

void seen_write_example(const char *path)
{
    weft_material material;
    weft_seen *seen;
    components_write_example(path);
    if (weft_material_read(path, &material, NULL) != WEFT_OK ||
        weft_seen_create(SEEN_EXAMPLE_SIDE, material.level_count, &seen, NULL) != WEFT_OK)
        abort();
    seen->finer_levels = 2;
    seen->coarser_levels = 1;
    for (int i = 0; i < (2 + material.level_count) * SEEN_EXAMPLE_SIDE * SEEN_EXAMPLE_SIDE; i++)
        seen->cell[i] = seen_example_cell(i);
    weft_material_take_seen(&material, seen);
    if (weft_material_write(path, &material, NULL) != WEFT_OK)
        abort();
    weft_material_free(&material);
}
