#include "registration/lamp/read.h"

#include "base/picture/colour.h"
#include "base/picture/image.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

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

/* ---- The tone curve ---- */

weft_tone_curve weft_tone_srgb(void)
{
    weft_tone_curve tone;
    for (int i = 0; i <= WEFT_TONE_STEPS; i++)
        tone.linear[i] = weft_linear_of_srgb((float)i / WEFT_TONE_STEPS);
    return tone;
}

weft_tone_curve weft_tone_linear(void)
{
    weft_tone_curve tone;
    for (int i = 0; i <= WEFT_TONE_STEPS; i++)
        tone.linear[i] = (float)i / WEFT_TONE_STEPS;
    return tone;
}

void weft_tone_basis(double encoded, double value[WEFT_TONE_TERMS], double slope[WEFT_TONE_TERMS])
{
    const int spans = WEFT_TONE_TERMS - 3;
    double at = fmin(fmax(encoded, 0), 1) * spans;
    int first = at < spans ? (int)at : spans - 1;
    double t = at - first, u = 1 - t;
    memset(value, 0, WEFT_TONE_TERMS * sizeof *value);
    memset(slope, 0, WEFT_TONE_TERMS * sizeof *slope);
    const double cubic[4] = {u * u * u, 3 * t * t * (t - 2) + 4, 3 * u * u * (u - 2) + 4, t * t * t};
    const double square[4] = {-u * u, t * (3 * t - 4), u * (4 - 3 * u), t * t};
    for (int k = 0; k < 4; k++) {
        value[first + k] = cubic[k] / 6;
        slope[first + k] = square[k] / 2 * spans;
    }
}

double weft_tone_bend(weft_tone_curve *tone, const double term[WEFT_TONE_TERMS])
{
    double last = 0, value[WEFT_TONE_TERMS], slope[WEFT_TONE_TERMS];
    for (int i = 0; i <= WEFT_TONE_STEPS; i++) {
        double sum = 0;
        weft_tone_basis(i / (double)WEFT_TONE_STEPS, value, slope);
        for (int k = 0; k < WEFT_TONE_TERMS; k++)
            sum += term[k] * value[k];
        double light = (double)tone->linear[i] * exp(sum);
        last = i ? fmax(last, light) : light;
        tone->linear[i] = (float)last;
    }
    for (int i = 0; i <= WEFT_TONE_STEPS; i++)
        tone->linear[i] /= (float)last;
    return last;
}

/* ---- The exposure that a camera means ---- */

/* What cameras write: below 100 these numbers and their reciprocals, from there on these of every decade. */
static const double small[] = {0.3, 0.6, 0.8, 1,  1.3, 1.6, 2,  2.5, 3,  3.2, 4,  5,  6,  6.4,
                               8,   10,  13,  15, 16,  20,  25, 30,  32, 40,  50, 60, 64, 80};
static const double large[] = {1, 1.25, 1.6, 2, 2.5, 3.2, 4, 5, 6.4, 8};

static bool holds(const double *list, size_t count, double value)
{
    const double near = 1e-3; /* fractions in a file */
    for (size_t i = 0; i < count; i++) {
        if (fabs(value / list[i] - 1) < near)
            return true;
    }
    return false;
}

static bool is_round(double value)
{
    if (value < 99)
        return holds(small, sizeof small / sizeof *small, value);
    return holds(large, sizeof large / sizeof *large, value / pow(10, floor(log10(value) + 1e-3)));
}

double weft_exposure_meant(double written)
{
    if (!(written > 0) || !(is_round(written) || is_round(1 / written)))
        return written;
    return exp2(round(3 * log2(written)) / 3);
}

/* ISO counts from 100. */
static double sensitivity_meant(double written)
{
    const double first = 100;
    return is_round(written) ? first * exp2(round(3 * log2(written / first)) / 3) : written;
}

double weft_exif_exposure(const weft_exif *exif)
{
    if (!(exif->f_number > 0))
        return 0;
    return weft_exposure_meant(exif->exposure_s) * sensitivity_meant(exif->iso) / (exif->f_number * exif->f_number);
}
