#include "compress/components/darkest.h"

#include "base/real.h"
#include "btf/material/components.h"

enum { CODES = 256, WHOLE = 1000, RUN = 64 };

/* The code that so many samples at most lie below, by a histogram over the codes. */
static uint8_t code_above(const int count[CODES], int below)
{
    int code = 0;
    for (int sum = count[0]; sum <= below && code < CODES - 1; sum += count[code])
        code++;
    return (uint8_t)code;
}

/* The codes of so many images. */
WEFT_HOT static void find_codes(const weft_component_images *images, const float *vector, size_t first, size_t length,
                                uint8_t code[3 * RUN])
{
    float divisor[3 * RUN];
    for (size_t i = 0; i < length; i++) {
        float of_image = images->weight[first + i] * images->height[first + i];
        divisor[3 * i] = divisor[3 * i + 1] = divisor[3 * i + 2] = of_image;
    }
    for (size_t i = 0; i < 3 * length; i++)
        code[i] = weft_floor_code(vector[3 * first + i] / divisor[i]);
}

void weft_floor_of_texel(const weft_component_images *images, const float *vector, const uint8_t *valid, float floor[3])
{
    int count[3][CODES] = {{0}}, samples = 0;
    size_t all = (size_t)images->image_count;
    for (size_t first = 0; first < all; first += RUN) {
        uint8_t code[3 * RUN];
        size_t length = all - first < RUN ? all - first : RUN;
        find_codes(images, vector, first, length, code);
        for (size_t i = 0; i < length; i++) {
            int known = valid[first + i] != 0;
            samples += known;
            for (size_t c = 0; c < 3; c++)
                count[c][code[3 * i + c]] += known;
        }
    }
    int below = (int)((long)samples * WEFT_DARKER_OF_1000 / WHOLE);
    for (int c = 0; c < 3; c++)
        floor[c] = samples < WEFT_LEAST_IMAGES_OF_A_FLOOR ? 0 : weft_floor_of_code(code_above(count[c], below));
}
