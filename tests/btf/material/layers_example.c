#include "tests/btf/material/layers_example.h"

#include "btf/material/material.h"
#include "tests/btf/material/weft_bytes.h"

#include <stdlib.h>

enum { LAYERS = 8, VIEWS = 3, IMAGES = 7 };

static void fill_shared(weft_layers *layers)
{
    static const uint32_t first[VIEWS + 1] = {0, 2, 3, 7};
    for (int i = 0; i < 3 * VIEWS; i++)
        layers->view[i] = i % 3 == 2 ? 1 : 0;
    for (int i = 0; i < IMAGES; i++) {
        layers->light[3 * i] = 0.1f * (float)i;
        layers->light[3 * i + 2] = sqrtf(1 - 0.01f * (float)(i * i));
    }
    for (int i = 0; i <= VIEWS; i++)
        layers->first[i] = first[i];
    for (int k = 0; k < LAYERS; k++)
        layers->scale[k] = 0.25f / (float)(k + 1);
    for (int i = 0; i < 3 * IMAGES * LAYERS; i++)
        layers->value[i] = weft_half_of_float((float)(i % 23) / 16 - 0.5f);
}

void layers_write_example(const char *path)
{
    const weft_layers shape = {.kind = WEFT_LAYERS_OF_HALF_VECTOR,
                               .layer_count = LAYERS,
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
        weft_layers_create(&shape, material.level[0].width, material.level[0].height, material.level_count,
                           &material.layers, NULL) != WEFT_OK)
        abort();
    fill_shared(material.layers);
    for (int k = 0; k < material.level_count; k++) {
        weft_layers_level *level = &material.layers->level[k];
        for (int i = 0; i < level->width * level->height * LAYERS; i++)
            level->coefficient[i] = (int8_t)((i * 31 + k) % 255 - 127);
        for (size_t i = 0; i < weft_ceiling_count(level->width, level->height); i++)
            level->ceiling[i] = (uint8_t)(200 + k);
        for (size_t i = 0; i < 3 * weft_ceiling_count(level->width, level->height); i++)
            level->floor[i] = (uint8_t)(100 + 10 * k + (int)i);
    }
    material.has_layers = material.has_floors = true;
    if (weft_material_write(path, &material, NULL) != WEFT_OK)
        abort();
    weft_material_free(&material);
}
