#include "compress/run/frames_and_opacity.h"

#include "base/integers.h"
#include "btf/direction/frame.h"

#include <stdlib.h>

static weft_vec3 vector_of(const float *from)
{
    return weft_vec3_of((weft_real)from[0], (weft_real)from[1], (weft_real)from[2]);
}

static void encode_texel(const float *from, int16_t code[3])
{
    weft_vec3 normal = weft_unit(vector_of(from)), tangent = vector_of(from + 3);
    weft_frame frame = {normal, tangent, weft_cross(normal, tangent)};
    weft_frame_encode(&frame, code);
}

static weft_code store_level_0(weft_dataset *dataset, weft_material_level *level, weft_error *error)
{
    size_t width = (size_t)level->width, bytes = 6 * width * sizeof(float);
    float *row = malloc(bytes);
    weft_code code = row ? WEFT_OK : weft_fail_memory(error, "frames of a row", bytes);
    for (int y = 0; code == WEFT_OK && y < level->height; y++) {
        code = weft_dataset_read_frames(dataset, y, 1, row, error);
        for (size_t x = 0; code == WEFT_OK && x < width; x++)
            encode_texel(row + 6 * x, level->frame + 3 * ((size_t)y * width + x));
    }
    free(row);
    return code;
}

static void average_group(const weft_material_level *from, int x, int y, int16_t code[3])
{
    weft_frame_sum sum = {0};
    for (int row = 2 * y; row < 2 * y + 2 && row < from->height; row++) {
        for (int column = 2 * x; column < 2 * x + 2 && column < from->width; column++) {
            weft_frame frame =
                weft_frame_decode(from->frame + 3 * ((size_t)row * (size_t)from->width + (size_t)column));
            weft_frame_sum_add(&sum, frame.normal, frame.tangent, 1);
        }
    }
    weft_frame mean = weft_frame_of_sum(&sum);
    weft_frame_encode(&mean, code);
}

weft_code weft_given_frames_store(weft_dataset *dataset, weft_material *material, weft_error *error)
{
    WEFT_TRY(store_level_0(dataset, &material->level[0], error));
    for (int k = 1; k < material->level_count; k++) {
        weft_material_level *level = &material->level[k];
        for (int i = 0; i < level->width * level->height; i++)
            average_group(&material->level[k - 1], i % level->width, i / level->width, level->frame + 3 * (size_t)i);
    }
    return WEFT_OK;
}

/* ---- Opacity ---- */

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
