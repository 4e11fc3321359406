#include "import/decode.h"

#include "base/picture/colour_claim.h"
#include "base/picture/image.h"
#include "import/reduce.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Colour and light of a pixel ---- */

/* What the numbers mean: as the user says, else as the file does. Floats are linear. */
static void choose_colours(const weft_decoding *decoding, weft_image_kind kind, weft_colour_claim *claim)
{
    if (decoding->options->colours != WEFT_IMPORT_AS_SAID) {
        claim->kind = WEFT_CLAIM_CLEAR;
        claim->words[0] = 0;
        weft_colour_space_make((weft_known_colours)(decoding->options->colours - WEFT_IMPORT_SRGB), &claim->space);
        if (claim->is_grey)
            weft_colour_space_make_grey(&claim->space);
    }
    if (decoding->options->linear || kind == WEFT_IMAGE_FLOAT)
        weft_colour_space_make_linear(&claim->space);
}

/* Linear light in place; flags clipped pixels. */
static void linearise(weft_image *image, const weft_decoding *decoding, const weft_colour_space *space,
                      uint8_t *flagged)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++) {
        float *pixel = image->pixels + 3 * i;
        double brightest = fmax(fmax((double)pixel[0], (double)pixel[1]), (double)pixel[2]);
        flagged[i] = brightest >= decoding->options->saturated_at ? WEFT_MASK_SATURATED : 0;
        for (int c = 0; c < 3; c++)
            pixel[c] = weft_curve_decode(&space->curve[c], pixel[c]);
    }
}

/* Flags the pixels that a partial image lacks, and makes them 0. */
static void flag_missing(weft_image *image, uint8_t *flagged)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count && image->is_partial; i++) {
        float *pixel = image->pixels + 3 * i;
        if (isnan(pixel[0]) && isnan(pixel[1]) && isnan(pixel[2])) {
            flagged[i] = WEFT_MASK_MISSING;
            pixel[0] = pixel[1] = pixel[2] = 0;
        }
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

/* The power of a near light is one of the colours of the file, and white stays white, so it goes before the primaries.
 */
static weft_code convert(const weft_decoding *decoding, const char *path, const weft_photograph *photograph,
                         weft_shown_photograph *shown, weft_half *samples, uint8_t *mask, weft_error *error)
{
    weft_image *image = &shown->image;
    if (image->width != decoding->source_width || image->height != decoding->source_height)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is %d x %d pixels, but the first photograph %d x %d", path,
                         image->width, image->height, decoding->source_width, decoding->source_height);
    size_t count = (size_t)image->width * (size_t)image->height;
    uint8_t *flagged = calloc(count, 1);
    if (!flagged)
        return weft_fail_memory(error, "mask", count);
    /* Float images have no known clipping level. */
    if (shown->kind == WEFT_IMAGE_INTEGER)
        linearise(image, decoding, &shown->claim.space, flagged);
    flag_missing(image, flagged);
    if (decoding->distance == WEFT_NEAR)
        divide_by_near_light(decoding, photograph, image);
    weft_colour_space_to_srgb(&shown->claim.space, image->pixels, count);
    weft_divide_by_white(decoding->options->white, image);
    weft_code code = check_finite(image, path, error);
    if (code == WEFT_OK)
        code = weft_reduce(image, flagged, decoding->width, decoding->height, samples, mask, error);
    free(flagged);
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
        if (mask[i] & WEFT_MASK_MISSING)
            mask[i] = WEFT_MASK_MISSING;
        decoded->missing += mask[i] == WEFT_MASK_MISSING;
        decoded->saturated += mask[i] == WEFT_MASK_SATURATED;
        decoded->sum += mask[i] ? 0 : sum_of(samples + 3 * i);
        decoded->outside += is_turned && !mask[i] && has_negative(samples + 3 * i);
    }
}

weft_code weft_shown_photograph_read(const char *path, weft_shown_photograph *photograph, weft_error *error)
{
    weft_exif exif;
    WEFT_TRY(weft_colour_claim_read(path, &photograph->image, &photograph->kind, &exif, &photograph->claim, error));
    weft_code code = weft_image_turn(&photograph->image, exif.orientation, error);
    if (code != WEFT_OK)
        weft_image_free(&photograph->image);
    return code;
}

weft_code weft_photograph_decode(const weft_decoding *decoding, const char *path, const weft_photograph *photograph,
                                 weft_shown_photograph *shown, weft_half *samples, uint8_t *mask, weft_decoded *decoded,
                                 weft_error *error)
{
    weft_colour_claim *claim = &shown->claim;
    *decoded = (weft_decoded){0};
    choose_colours(decoding, shown->kind, claim);
    WEFT_TRY(convert(decoding, path, photograph, shown, samples, mask, error));
    decoded->claim = claim->kind;
    decoded->has_more = claim->has_more;
    /* Whoever says that all are linear has answered. */
    if (!(claim->kind == WEFT_CLAIM_NONE && decoding->options->linear))
        memcpy(decoded->words, claim->words, sizeof decoded->words);
    count_texels(decoding, &claim->space, samples, mask, decoded);
    decoded->light = weft_photograph_light_of(samples, mask, decoding->width, decoding->height);
    return WEFT_OK;
}
