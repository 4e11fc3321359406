#include "tests/btf/material/components_example.h"

#include "btf/material/material.h"
#include "tests/btf/material/weft_bytes.h"

#include <stdlib.h>

enum { COMPONENTS = 8, VIEWS = 3, IMAGES = 7 };

static void fill_shared(weft_components *components)
{
    static const uint32_t first[VIEWS + 1] = {0, 2, 3, 7};
    for (int i = 0; i < 3 * VIEWS; i++)
        components->view[i] = i % 3 == 2 ? 1 : 0;
    for (int i = 0; i < IMAGES; i++) {
        components->light[3 * i] = 0.1f * (float)i;
        components->light[3 * i + 2] = sqrtf(1 - 0.01f * (float)(i * i));
    }
    for (int i = 0; i <= VIEWS; i++)
        components->first[i] = first[i];
    for (int k = 0; k < COMPONENTS; k++)
        components->scale[k] = 0.015625f / (float)(k + 1);
    for (int i = 0; i < 3 * IMAGES * COMPONENTS; i++)
        components->value[i] = weft_half_of_float((float)(i % 23 - 8));
}

void components_write_example(const char *path)
{
    const weft_components shape = {.kind = WEFT_COMPONENTS_OF_HALF_VECTOR,
                                   .component_count = COMPONENTS,
                                   .view_count = VIEWS,
                                   .image_count = IMAGES,
                                   .light_side = 5,
                                   .view_side = 4,
                                   .light_smoothness = 0.5f,
                                   .view_smoothness = 0.25f,
                                   .least_cosine = 0.125f};
    weft_material material;
    weft_bytes_write_example(path);
    if (weft_material_read(path, &material, NULL) != WEFT_OK ||
        weft_components_create(&shape, material.level[0].width, material.level[0].height, material.level_count,
                               &material.components, NULL) != WEFT_OK)
        abort();
    fill_shared(material.components);
    for (int k = 0; k < material.level_count; k++) {
        weft_components_level *level = &material.components->level[k];
        for (int i = 0; i < level->width * level->height * COMPONENTS; i++)
            level->coefficient[i] = (int8_t)((i * 31 + k) % 255 - 127);
        for (size_t i = 0; i < weft_ceiling_count(level->width, level->height); i++)
            level->ceiling[i] = (uint8_t)(200 + k);
        for (size_t i = 0; i < 3 * weft_ceiling_count(level->width, level->height); i++)
            level->floor[i] = (uint8_t)(100 + 10 * k + (int)i);
    }
    if (weft_material_write(path, &material, NULL) != WEFT_OK)
        abort();
    weft_material_free(&material);
}
