#include "compress/layers/darkest.h"

#include "btf/material/layers.h"

enum { CODES = 256, WHOLE = 1000 };

/* The code that so many samples at most lie below, by a histogram over the codes. */
static uint8_t code_above(const int count[CODES], int below)
{
    int code = 0;
    for (int sum = count[0]; sum <= below && code < CODES - 1; sum += count[code])
        code++;
    return (uint8_t)code;
}

void weft_floor_of_texel(const weft_layer_images *images, const float *vector, const uint8_t *valid, float floor[3])
{
    int count[3][CODES] = {{0}}, samples = 0;
    for (size_t i = 0; i < (size_t)images->image_count; i++) {
        float divisor = images->weight[i] * (float)images->light[i].z;
        if (!valid[i])
            continue;
        samples++;
        for (size_t c = 0; c < 3; c++)
            count[c][weft_floor_code(vector[3 * i + c] / divisor)]++;
    }
    int below = (int)((long)samples * WEFT_DARKER_OF_1000 / WHOLE);
    for (int c = 0; c < 3; c++)
        floor[c] = samples < WEFT_LEAST_IMAGES_OF_A_FLOOR ? 0 : weft_floor_of_code(code_above(count[c], below));
}
