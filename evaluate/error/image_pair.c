#include "evaluate/error/image_pair.h"

#include <stdlib.h>

weft_code weft_image_pair_create(const weft_dataset_layout *layout, int image, weft_image_pair *pair, weft_error *error)
{
    *pair = (weft_image_pair){.image = image};
    size_t texels = (size_t)layout->width * (size_t)layout->height;
    WEFT_TRY(weft_image_create(layout->width, layout->height, &pair->sample, error));
    WEFT_TRY(weft_image_create(layout->width, layout->height, &pair->prediction, error));
    pair->mask = calloc(texels, 1);
    return pair->mask ? WEFT_OK : weft_fail_memory(error, "mask", texels);
}

void weft_image_pair_free(weft_image_pair *pair)
{
    weft_image_free(&pair->sample);
    weft_image_free(&pair->prediction);
    free(pair->mask);
    *pair = (weft_image_pair){0};
}

static void store_prediction(weft_image *image, size_t texel, weft_rgb value)
{
    image->pixels[3 * texel] = (float)value.r;
    image->pixels[3 * texel + 1] = (float)value.g;
    image->pixels[3 * texel + 2] = (float)value.b;
}

void weft_image_pair_fill(weft_image_pair *pair, const weft_dataset_layout *layout, const weft_predictor *predictor,
                          int y, int rows, const weft_half *samples, const uint8_t *mask)
{
    size_t width = (size_t)layout->width, images = (size_t)layout->image_count;
    for (size_t t = 0; t < (size_t)rows * width; t++) {
        size_t texel = (size_t)y * width + t, index = t * images + (size_t)pair->image;
        pair->mask[texel] = mask[index];
        for (size_t c = 0; c < 3; c++)
            pair->sample.pixels[3 * texel + c] = weft_float_of_half(samples[3 * index + c]);
        weft_rgb prediction;
        weft_predictor_predict(predictor, (int)(t % width), y + (int)(t / width), &pair->image, 1, &prediction);
        store_prediction(&pair->prediction, texel, prediction);
    }
}

weft_code weft_image_pair_error(const weft_image_pair *pair, weft_error_summary *result, weft_error *error)
{
    size_t values = 3 * (size_t)pair->sample.width * (size_t)pair->sample.height;
    weft_compared *value = malloc(values * sizeof *value);
    if (!value)
        return weft_fail_memory(error, "predictions", values * sizeof *value);
    size_t count = 0;
    for (size_t i = 0; i < values; i++) {
        if (pair->mask[i / 3] == 0)
            value[count++] =
                (weft_compared){.sample = pair->sample.pixels[i], .prediction = pair->prediction.pixels[i]};
    }
    weft_code code = weft_error_summary_of(value, count, result, error);
    free(value);
    return code;
}
