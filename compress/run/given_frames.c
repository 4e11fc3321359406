#include "compress/run/given_frames.h"

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
