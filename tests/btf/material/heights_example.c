#include "tests/btf/material/heights_example.h"

#include "tests/btf/material/components_example.h"

#include <stdlib.h>

static const float low_mm = -0.75f, high_mm = 0.5f;

uint8_t heights_example_code(int x, int y)
{
    return (uint8_t)((y * HEIGHTS_EXAMPLE_WIDTH + x) * 255 / (HEIGHTS_EXAMPLE_WIDTH * HEIGHTS_EXAMPLE_HEIGHT - 1));
}

void heights_write_example(const char *path)
{
    const double size_mm[2] = {2.5, 1.5};
    float value[HEIGHTS_EXAMPLE_HEIGHT][HEIGHTS_EXAMPLE_WIDTH];
    weft_material_heights *heights;
    weft_material material;
    for (int y = 0; y < HEIGHTS_EXAMPLE_HEIGHT; y++)
        for (int x = 0; x < HEIGHTS_EXAMPLE_WIDTH; x++)
            value[y][x] = low_mm + (float)heights_example_code(x, y) / 255 * (high_mm - low_mm);
    components_write_example(path);
    if (weft_material_read(path, &material, NULL) != WEFT_OK ||
        weft_material_heights_create(value[0], HEIGHTS_EXAMPLE_WIDTH, HEIGHTS_EXAMPLE_HEIGHT, 2, size_mm, &heights,
                                     NULL) != WEFT_OK)
        abort();
    weft_material_take_heights(&material, heights);
    if (weft_material_write(path, &material, NULL) != WEFT_OK)
        abort();
    weft_material_free(&material);
}
