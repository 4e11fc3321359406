#include "registration/lamp/read.h"

#include "base/picture/image.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

weft_file_range weft_file_range_of(const weft_exif *exif, double clipped_at)
{
    const double steps = 5;
    double all = exif->is_float || exif->bits > 16 ? WEFT_PHOTOGRAPHS_FULL_SCALE : exp2(exif->bits) - 1;
    return (weft_file_range){exif->is_float ? INFINITY : (float)clipped_at, (float)(steps / all)};
}

static void decode_pixel(const weft_tone_curve *tone, float clipped_at, const float encoded[3], uint16_t *sample,
                         float *grey)
{
    float sum = 0;
    for (int c = 0; c < 3; c++) {
        bool clipped = !(encoded[c] < clipped_at);
        float light = weft_tone_decode(tone, encoded[c]);
        sample[c] =
            clipped ? WEFT_PHOTOGRAPHS_FULL_SCALE : (uint16_t)fminf(light * WEFT_PHOTOGRAPHS_FULL_SCALE + 0.5f, 65534);
        sum += clipped ? NAN : light;
    }
    *grey = sum / 3;
}

weft_code weft_light_values_read(const char *path, int width, int height, const weft_tone_curve *tone,
                                 weft_file_range range, weft_light_values *values, weft_error *error)
{
    weft_image image;
    *values = (weft_light_values){width, height, NULL, NULL, weft_tone_decode(tone, range.dark_at)};
    WEFT_TRY(weft_image_read(path, &image, NULL, error));
    size_t pixels = (size_t)image.width * (size_t)image.height;
    weft_code code = WEFT_OK;
    if (image.width != width || image.height != height)
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s' has %d x %d pixels, not %d x %d as the others", path, image.width,
                         image.height, width, height);
    else if (!(values->samples = malloc(pixels * 3 * sizeof *values->samples)) ||
             !(values->grey = malloc(pixels * sizeof *values->grey)))
        code = weft_fail_memory(error, path, pixels * 10);
    for (size_t i = 0; code == WEFT_OK && i < pixels; i++)
        decode_pixel(tone, range.clipped_at, image.pixels + 3 * i, values->samples + 3 * i, values->grey + i);
    weft_image_free(&image);
    if (code != WEFT_OK)
        weft_light_values_free(values);
    return code;
}

void weft_light_values_free(weft_light_values *values)
{
    free(values->samples);
    free(values->grey);
    values->samples = NULL;
    values->grey = NULL;
}
