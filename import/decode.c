#include "import/decode.h"

#include "base/picture/colour.h"
#include "base/picture/image.h"
#include "import/reduce.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Colour and light of a pixel ---- */

/* Linear light in place; marks clipped pixels. Float images have no known clipping level. */
static void linearise(weft_image *image, const weft_decoding *decoding, uint8_t *clipped)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++) {
        float *pixel = image->pixels + 3 * i;
        double brightest = fmax(fmax((double)pixel[0], (double)pixel[1]), (double)pixel[2]);
        clipped[i] = brightest >= decoding->saturated_at;
        for (int c = 0; c < 3 && !decoding->linear; c++)
            pixel[c] = weft_linear_of_srgb(pixel[c]);
    }
}

/* Squared distance from the centre of a pixel to the light, mm^2. */
static double squared_distance(const weft_decoding *decoding, weft_vec3 light, int x, int y)
{
    double pixel_x = (x + 0.5 - 0.5 * decoding->source_width) * decoding->pixel_pitch_mm;
    double pixel_y = (0.5 * decoding->source_height - y - 0.5) * decoding->pixel_pitch_mm;
    weft_vec3 to_light = weft_subtract(light, weft_vec3_of(pixel_x, pixel_y, 0));
    return weft_dot(to_light, to_light);
}

/* p = BRDF cos I / d^2, so BRDF pi cos = pi p d^2 / I. */
static void divide_by_near_light(const weft_decoding *decoding, const weft_photograph *photograph, weft_image *image)
{
    const weft_rgb *intensity = &photograph->intensity;
    double scale[3] = {WEFT_PI / intensity->r, WEFT_PI / intensity->g, WEFT_PI / intensity->b};
    float *pixel = image->pixels;
    for (int y = 0; y < image->height; y++) {
        for (int x = 0; x < image->width; x++, pixel += 3) {
            double d2 = squared_distance(decoding, photograph->light, x, y);
            for (int c = 0; c < 3; c++)
                pixel[c] = (float)(pixel[c] * scale[c] * d2);
        }
    }
}

static weft_code check_finite(const weft_image *image, const char *path, weft_error *error)
{
    size_t index;
    if (!weft_find_unstorable(image, &index))
        return WEFT_OK;
    size_t pixel = index / 3, width = (size_t)image->width;
    return weft_fail(error, WEFT_BAD_INPUT, "'%s': value %g at pixel (%zu, %zu)", path, (double)image->pixels[index],
                     pixel % width, pixel / width);
}

/* ---- A photograph ---- */

static weft_code convert(const weft_decoding *decoding, const char *path, const weft_photograph *photograph,
                         weft_image *image, weft_image_kind kind, weft_half *samples, uint8_t *mask, weft_error *error)
{
    if (image->width != decoding->source_width || image->height != decoding->source_height)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is %d x %d pixels, but the first photograph %d x %d", path,
                         image->width, image->height, decoding->source_width, decoding->source_height);
    size_t count = (size_t)image->width * (size_t)image->height;
    uint8_t *clipped = calloc(count, 1);
    if (!clipped)
        return weft_fail_memory(error, "mask", count);
    if (kind == WEFT_IMAGE_INTEGER)
        linearise(image, decoding, clipped);
    if (decoding->distance == WEFT_NEAR)
        divide_by_near_light(decoding, photograph, image);
    weft_code code = check_finite(image, path, error);
    if (code == WEFT_OK)
        code = weft_reduce(image, clipped, decoding->width, decoding->height, samples, mask, error);
    free(clipped);
    return code;
}

weft_code weft_photograph_decode(const weft_decoding *decoding, const char *path, const weft_photograph *photograph,
                                 weft_half *samples, uint8_t *mask, size_t *saturated, weft_error *error)
{
    weft_image image;
    weft_image_kind kind;
    WEFT_TRY(weft_image_read_shown(path, &image, &kind, error));
    weft_code code = convert(decoding, path, photograph, &image, kind, samples, mask, error);
    weft_image_free(&image);
    *saturated = 0;
    size_t count = (size_t)decoding->width * (size_t)decoding->height;
    for (size_t i = 0; code == WEFT_OK && i < count; i++) {
        mask[i] = mask[i] ? WEFT_MASK_SATURATED : 0;
        *saturated += mask[i] != 0;
    }
    return code;
}
