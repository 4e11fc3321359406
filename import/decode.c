#include "import/decode.h"

#include "base/picture/colour_claim.h"
#include "base/picture/image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double largest_half = 65504;

/* ---- Colour and light of a pixel ---- */

/* What the numbers mean: as the user says, else as the file does. Floats are linear. */
static weft_code find_colours(const weft_decoding *decoding, const char *path, weft_image_kind kind,
                              weft_colour_claim *claim, weft_error *error)
{
    WEFT_TRY(weft_colour_claim_read(path, claim, error));
    if (decoding->colours != WEFT_IMPORT_AS_SAID) {
        claim->kind = WEFT_CLAIM_CLEAR;
        claim->words[0] = 0;
        weft_colour_space_make((weft_known_colours)(decoding->colours - WEFT_IMPORT_SRGB), &claim->space);
        if (claim->is_grey)
            weft_colour_space_make_grey(&claim->space);
    }
    if (decoding->linear || kind == WEFT_IMAGE_FLOAT)
        weft_colour_space_make_linear(&claim->space);
    return WEFT_OK;
}

/* Linear light in place; marks clipped pixels. */
static void linearise(weft_image *image, const weft_decoding *decoding, const weft_colour_space *space,
                      uint8_t *clipped)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++) {
        float *pixel = image->pixels + 3 * i;
        double brightest = fmax(fmax((double)pixel[0], (double)pixel[1]), (double)pixel[2]);
        clipped[i] = brightest >= decoding->saturated_at;
        for (int c = 0; c < 3; c++)
            pixel[c] = weft_curve_decode(&space->curve[c], pixel[c]);
    }
}

/* Before the range of half floats is looked at. */
static void divide_by_white(const weft_decoding *decoding, weft_image *image)
{
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count && decoding->white != 1; i++)
        image->pixels[i] = (float)((double)image->pixels[i] / decoding->white);
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
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++) {
        if (!(fabs((double)image->pixels[i]) <= largest_half)) {
            size_t pixel = i / 3, width = (size_t)image->width;
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': value %g at pixel (%zu, %zu)", path,
                             (double)image->pixels[i], pixel % width, pixel / width);
        }
    }
    return WEFT_OK;
}

/* ---- Reduction to texels by exact area averaging ---- */

/* The part of an axis under one pixel of the result: pixels first..last with weights that are 1 inside. */
typedef struct span {
    int first, last;
    double first_weight, last_weight;
} span;

static span span_of(int index, int source_count, int result_count)
{
    /* Bounds as whole numbers over result_count, so that equal ratios give exactly whole spans. */
    long begin = (long)index * source_count, end = begin + source_count;
    int first = (int)(begin / result_count), last = (int)((end - 1) / result_count);
    double first_end = fmin((double)end, (double)(first + 1) * result_count);
    double last_begin = fmax((double)begin, (double)last * result_count);
    return (span){first, last, (first_end - (double)begin) / result_count, ((double)end - last_begin) / result_count};
}

static double weight_in(const span *s, int index)
{
    return index == s->first ? s->first_weight : index == s->last ? s->last_weight : 1;
}

static void average_pixel(const weft_image *image, const uint8_t *flagged, const span *sx, const span *sy, float *pixel,
                          uint8_t *touched)
{
    double sum[3] = {0}, area = 0;
    *touched = 0;
    for (int y = sy->first; y <= sy->last; y++) {
        for (int x = sx->first; x <= sx->last; x++) {
            size_t at = (size_t)y * (size_t)image->width + (size_t)x;
            double weight = weight_in(sx, x) * weight_in(sy, y);
            for (int c = 0; c < 3; c++)
                sum[c] += weight * (double)image->pixels[3 * at + (size_t)c];
            area += weight;
            *touched |= flagged[at];
        }
    }
    for (int c = 0; c < 3; c++)
        pixel[c] = (float)(sum[c] / area);
}

/* Every pixel of `result` (allocated, no larger than `image`) becomes the mean of `image` over the area it covers;
 * pixels that are covered in part count by that part. touched [result height][width] = whether any pixel with flagged
 * [image height][width] != 0 took part. */
static weft_code area_average(const weft_image *image, const uint8_t *flagged, weft_image *result, uint8_t *touched,
                              weft_error *error)
{
    span *sx = malloc((size_t)result->width * sizeof *sx);
    if (!sx)
        return weft_fail_memory(error, "spans", (size_t)result->width * sizeof *sx);
    for (int x = 0; x < result->width; x++)
        sx[x] = span_of(x, image->width, result->width);
    for (int y = 0; y < result->height; y++) {
        span sy = span_of(y, image->height, result->height);
        for (int x = 0; x < result->width; x++) {
            size_t at = (size_t)y * (size_t)result->width + (size_t)x;
            average_pixel(image, flagged, &sx[x], &sy, result->pixels + 3 * at, touched + at);
        }
    }
    free(sx);
    return WEFT_OK;
}

static weft_code average_texels(const weft_decoding *decoding, const weft_image *image, const uint8_t *clipped,
                                weft_half *samples, uint8_t *mask, weft_error *error)
{
    weft_image texels;
    WEFT_TRY(weft_image_create(decoding->width, decoding->height, &texels, error));
    weft_code code = area_average(image, clipped, &texels, mask, error);
    size_t count = 3 * (size_t)decoding->width * (size_t)decoding->height;
    for (size_t i = 0; code == WEFT_OK && i < count; i++)
        samples[i] = weft_half_of_float(texels.pixels[i]);
    weft_image_free(&texels);
    return code;
}

/* ---- A photograph ---- */

/* The power of a near light is one of the colours of the file, and white stays white, so it goes before the primaries.
 */
static weft_code convert(const weft_decoding *decoding, const char *path, const weft_photograph *photograph,
                         const weft_colour_space *space, weft_image *image, weft_image_kind kind, weft_half *samples,
                         uint8_t *mask, weft_error *error)
{
    if (image->width != decoding->source_width || image->height != decoding->source_height)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is %d x %d pixels, but the first photograph %d x %d", path,
                         image->width, image->height, decoding->source_width, decoding->source_height);
    size_t count = (size_t)image->width * (size_t)image->height;
    uint8_t *clipped = calloc(count, 1);
    if (!clipped)
        return weft_fail_memory(error, "mask", count);
    /* Float images have no known clipping level. */
    if (kind == WEFT_IMAGE_INTEGER)
        linearise(image, decoding, space, clipped);
    if (decoding->distance == WEFT_NEAR)
        divide_by_near_light(decoding, photograph, image);
    weft_colour_space_to_srgb(space, image->pixels, count);
    divide_by_white(decoding, image);
    weft_code code = check_finite(image, path, error);
    if (code == WEFT_OK)
        code = average_texels(decoding, image, clipped, samples, mask, error);
    free(clipped);
    return code;
}

static double sum_of(const weft_half sample[3])
{
    return (double)weft_float_of_half(sample[0]) + (double)weft_float_of_half(sample[1]) +
           (double)weft_float_of_half(sample[2]);
}

static bool has_negative(const weft_half sample[3])
{
    bool is = false;
    for (int c = 0; c < 3; c++)
        is = is || weft_float_of_half(sample[c]) < 0;
    return is;
}

/* Negative samples of a file in sRGB are its noise. */
static void count_texels(const weft_decoding *decoding, const weft_colour_space *space, const weft_half *samples,
                         uint8_t *mask, weft_decoded *decoded)
{
    bool is_turned = !weft_colour_space_has_srgb_primaries(space);
    size_t count = (size_t)decoding->width * (size_t)decoding->height;
    for (size_t i = 0; i < count; i++) {
        mask[i] = mask[i] ? WEFT_MASK_SATURATED : 0;
        decoded->saturated += mask[i] != 0;
        decoded->sum += mask[i] ? 0 : sum_of(samples + 3 * i);
        decoded->outside += is_turned && !mask[i] && has_negative(samples + 3 * i);
    }
}

weft_code weft_photograph_decode(const weft_decoding *decoding, const char *path, const weft_photograph *photograph,
                                 weft_half *samples, uint8_t *mask, weft_decoded *decoded, weft_error *error)
{
    weft_image image;
    weft_image_kind kind;
    weft_colour_claim claim;
    *decoded = (weft_decoded){0};
    WEFT_TRY(weft_image_read_shown(path, &image, &kind, error));
    weft_code code = find_colours(decoding, path, kind, &claim, error);
    if (code == WEFT_OK)
        code = convert(decoding, path, photograph, &claim.space, &image, kind, samples, mask, error);
    weft_image_free(&image);
    WEFT_TRY(code);
    decoded->claim = claim.kind;
    decoded->has_more = claim.has_more;
    /* Whoever says that all are linear has answered. */
    if (!(claim.kind == WEFT_CLAIM_NONE && decoding->linear))
        memcpy(decoded->words, claim.words, sizeof decoded->words);
    count_texels(decoding, &claim.space, samples, mask, decoded);
    return WEFT_OK;
}
