#include "capture/camera/camera.h"

#include "base/picture/colour.h"

#include <math.h>
#include <stddef.h>

static uint16_t quantised(float value)
{
    const float full_scale = (1 << WEFT_FRAME_BITS) - 1;
    return (uint16_t)lroundf(fminf(fmaxf(value, 0), 1) * full_scale);
}

/* The mean of a block whose top left value is `from`: of linear values, as light adds up. */
static float mean_of_block(const float *from, size_t row, const weft_frame_format *format)
{
    float sum = 0;
    for (int y = 0; y < format->bin; y++) {
        for (int x = 0; x < format->bin; x++) {
            float value = from[(size_t)y * row + 3 * (size_t)x];
            sum += format->srgb ? weft_linear_of_srgb(value) : value;
        }
    }
    return sum / (float)(format->bin * format->bin);
}

weft_code weft_frame_develop(const weft_image *image, const weft_frame_format *format, const char *camera,
                             uint16_t *samples, weft_error *error)
{
    int bin = format->bin;
    if (image->width != bin * format->width || image->height != bin * format->height)
        return weft_fail(error, WEFT_SYSTEM,
                         "%s: the frame has %d x %d pixels, not %d times %d x %d of its calibration", camera,
                         image->width, image->height, bin, format->width, format->height);
    size_t row = 3 * (size_t)image->width;
    for (int y = 0; y < format->height; y++) {
        for (int i = 0; i < 3 * format->width; i++) {
            const float *block = image->pixels + (size_t)(bin * y) * row + (size_t)(3 * bin * (i / 3) + i % 3);
            *samples++ = quantised(mean_of_block(block, row, format));
        }
    }
    return WEFT_OK;
}

weft_code weft_frame_exposure(double said_s, const weft_frame_format *format, const char *camera, double *exposure_s,
                              weft_error *error)
{
    *exposure_s = said_s > 0 ? said_s : format->exposure_s;
    return *exposure_s > 0
               ? WEFT_OK
               : weft_fail(error, WEFT_SYSTEM, "%s: the frame does not say how long it was exposed", camera);
}
