#include "compress/run/opacity.h"

#include "base/integers.h"

#include <stdlib.h>

static weft_code store_opacity(weft_dataset *dataset, weft_material *material, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    size_t width = (size_t)layout->width, views = (size_t)layout->view_count, texels = width * (size_t)layout->height;
    float *row = malloc(width * views * sizeof *row);
    weft_code code = row ? WEFT_OK : weft_fail_memory(error, "opacity of a row", width * views * sizeof *row);
    for (int y = 0; code == WEFT_OK && y < layout->height; y++) {
        code = weft_dataset_read_opacity(dataset, y, 1, row, error);
        for (size_t i = 0; code == WEFT_OK && i < width * views; i++) {
            size_t texel = (size_t)y * width + i / views;
            float alpha = row[i] < 0 ? 0 : row[i] > 1 ? 1 : row[i];
            material->level[0].table[((i % views) * texels + texel) * 4 + 3] = (uint8_t)(255 * alpha + 0.5f);
        }
    }
    free(row);
    return code;
}

/* Mean code of the texels of level 0 that belong to texel (x, y) of level k, as its samples do. */
static uint8_t mean_opacity(const weft_material_level *finest, const uint8_t *view, int k, int x, int y)
{
    int right = weft_smaller((x + 1) << k, finest->width), bottom = weft_smaller((y + 1) << k, finest->height);
    long sum = 0, count = (long)(right - (x << k)) * (bottom - (y << k));
    for (int row = y << k; row < bottom; row++)
        for (int column = x << k; column < right; column++)
            sum += view[4 * ((size_t)row * (size_t)finest->width + (size_t)column) + 3];
    return (uint8_t)((2 * sum + count) / (2 * count));
}

static void fill_opacity_level(weft_material *material, int k)
{
    const weft_material_level *finest = &material->level[0];
    weft_material_level *level = &material->level[k];
    size_t texels = (size_t)level->width * (size_t)level->height;
    for (size_t view = 0; view < (size_t)material->view_count; view++) {
        const uint8_t *from = finest->table + 4 * view * (size_t)finest->width * (size_t)finest->height;
        for (size_t i = 0; i < texels; i++)
            level->table[4 * (view * texels + i) + 3] =
                mean_opacity(finest, from, k, (int)(i % (size_t)level->width), (int)(i / (size_t)level->width));
    }
}

weft_code weft_opacity_fill(weft_dataset *dataset, weft_material *material, weft_error *error)
{
    if (material->view_count == 0)
        return WEFT_OK;
    WEFT_TRY(store_opacity(dataset, material, error));
    for (int level = 1; level < material->level_count; level++)
        fill_opacity_level(material, level);
    return WEFT_OK;
}
