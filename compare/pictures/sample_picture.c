#include "compare/pictures/sample_picture.h"

#include "base/numeric/statistics.h"
#include "base/picture/colour.h"

#include <math.h>
#include <stdlib.h>

static const float masked_grey = 0.55f;

weft_code weft_picture_exposure(const weft_image *image, const uint8_t *mask, double *exposure, weft_error *error)
{
    size_t texels = (size_t)image->width * (size_t)image->height, count = 0;
    float *value = malloc(3 * texels * sizeof *value);
    if (!value)
        return weft_fail_memory(error, "the values of a picture", 3 * texels * sizeof *value);
    for (size_t i = 0; i < 3 * texels; i++) {
        if (!(mask && mask[i / 3]) && isfinite(image->pixels[i]))
            value[count++] = image->pixels[i];
    }
    double high = (double)weft_quantile_of_floats(value, count, 0.99);
    free(value);
    *exposure = high > 0 ? 0.9 / high : 1;
    return WEFT_OK;
}

weft_code weft_picture_encode(const weft_image *linear, const uint8_t *mask, double exposure, weft_image *result,
                              weft_error *error)
{
    WEFT_TRY(weft_image_create(linear->width, linear->height, result, error));
    size_t count = 3 * (size_t)linear->width * (size_t)linear->height;
    for (size_t i = 0; i < count; i++) {
        float encoded = weft_srgb_of_linear((float)((double)linear->pixels[i] * exposure));
        result->pixels[i] = mask && mask[i / 3] ? masked_grey : fminf(encoded, 1);
    }
    return WEFT_OK;
}

weft_code weft_picture_difference(const weft_image *a, const weft_image *b, const uint8_t *mask, double exposure,
                                  weft_image *result, weft_error *error)
{
    WEFT_TRY(weft_image_create(a->width, a->height, result, error));
    size_t count = (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < count; i++) {
        float *rgb = result->pixels + 3 * i;
        if (mask && mask[i])
            rgb[0] = rgb[1] = rgb[2] = masked_grey;
        else
            weft_difference_colour((float)(exposure / WEFT_PICTURE_FULL_DIFFERENCE) *
                                       (weft_channel_mean(b->pixels + 3 * i) - weft_channel_mean(a->pixels + 3 * i)),
                                   rgb);
    }
    return WEFT_OK;
}
