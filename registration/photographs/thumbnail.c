#include "registration/photographs/thumbnail.h"

#include "base/picture/colour.h"

#include <math.h>

enum { photograph_width = 260, texels_width = 160 };

static int step_for(int width, int most)
{
    return (width + most - 1) / most;
}

weft_code weft_thumbnail_of_photograph(const weft_light_values *values, weft_image *thumbnail, weft_error *error)
{
    int step = step_for(values->width, photograph_width);
    WEFT_TRY(weft_image_create(values->width / step, values->height / step, thumbnail, error));
    for (int y = 0; y < thumbnail->height; y++) {
        for (int x = 0; x < thumbnail->width; x++) {
            float sum[3] = {0, 0, 0};
            for (int i = 0; i < step * step; i++) {
                const uint16_t *s =
                    values->samples + 3 * ((long)(y * step + i / step) * values->width + x * step + i % step);
                for (int c = 0; c < 3; c++)
                    sum[c] += s[c];
            }
            for (int c = 0; c < 3; c++)
                thumbnail->pixels[3 * ((long)y * thumbnail->width + x) + c] =
                    weft_srgb_of_linear(sum[c] / (float)(step * step * WEFT_PHOTOGRAPHS_FULL_SCALE));
        }
    }
    return WEFT_OK;
}

weft_code weft_thumbnail_of_texels(const weft_half *texel, int width, int height, weft_image *thumbnail,
                                   weft_error *error)
{
    int step = step_for(width > height ? width : height, texels_width);
    WEFT_TRY(weft_image_create(width / step, height / step, thumbnail, error));
    for (int y = 0; y < thumbnail->height; y++) {
        for (int x = 0; x < thumbnail->width; x++) {
            for (int c = 0; c < 3; c++) {
                float sum = 0;
                for (int i = 0; i < step * step; i++)
                    sum +=
                        weft_float_of_half(texel[3 * ((long)(y * step + i / step) * width + x * step + i % step) + c]);
                thumbnail->pixels[3 * ((long)y * thumbnail->width + x) + c] =
                    weft_srgb_of_linear(fminf(sum / (float)(step * step), 1));
            }
        }
    }
    return WEFT_OK;
}
