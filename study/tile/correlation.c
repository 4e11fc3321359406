/* Autocorrelation by the theorem of Wiener and Khinchin, padded so that it does not wrap, of the values and of the
 * masks: their quotient is the mean product of the pairs that are both valid (Padfield 2012). */
#include "study/tile/correlation.h"

#include "study/tile/fourier.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct spectra {
    int width, height;                /* padded */
    double *transform;                /* [height][width][2] of one picture */
    double *value_power, *mask_power; /* [height][width][2] sums over the pictures, imaginary part 0 */
} spectra;

static size_t spectrum_size(const spectra *of)
{
    return (size_t)of->width * (size_t)of->height;
}

/* The value of picture k where it is valid, or whether it is. */
static double texel(const weft_tile_pictures *pictures, int k, int x, int y, bool is_mask)
{
    size_t i = ((size_t)k * (size_t)pictures->height + (size_t)y) * (size_t)pictures->width + (size_t)x;
    return pictures->mask[i] ? 0 : is_mask ? 1 : (double)pictures->value[i];
}

static weft_code add_power(const weft_tile_pictures *pictures, int k, bool is_mask, spectra *of, weft_error *error)
{
    double *power = is_mask ? of->mask_power : of->value_power;
    memset(of->transform, 0, 2 * spectrum_size(of) * sizeof *of->transform);
    for (int y = 0; y < pictures->height; y++)
        for (int x = 0; x < pictures->width; x++)
            of->transform[2 * ((size_t)y * (size_t)of->width + (size_t)x)] = texel(pictures, k, x, y, is_mask);
    WEFT_TRY(weft_fourier_transform(of->transform, of->width, of->height, 0, error));
    for (size_t i = 0; i < spectrum_size(of); i++)
        power[2 * i] +=
            of->transform[2 * i] * of->transform[2 * i] + of->transform[2 * i + 1] * of->transform[2 * i + 1];
    return WEFT_OK;
}

/* Mean product at lags 0, stride, 2 stride, .. of the padded arrays, relative to lag 0. */
static void read_axis(const spectra *of, size_t stride, int count, double *along)
{
    double variance = of->value_power[0] / of->mask_power[0];
    for (int i = 0; i < count; i++) {
        size_t at = 2 * stride * (size_t)i;
        bool enough = 4 * of->mask_power[at] > of->mask_power[0];
        along[i] = enough && variance > 0 ? of->value_power[at] / of->mask_power[at] / variance : 0;
    }
}

static weft_code correlate(const weft_tile_pictures *pictures, spectra *of, weft_tile_correlation *correlation,
                           weft_error *error)
{
    for (int k = 0; k < pictures->count; k++) {
        WEFT_TRY(add_power(pictures, k, false, of, error));
        WEFT_TRY(add_power(pictures, k, true, of, error));
    }
    WEFT_TRY(weft_fourier_transform(of->value_power, of->width, of->height, 1, error));
    WEFT_TRY(weft_fourier_transform(of->mask_power, of->width, of->height, 1, error));
    read_axis(of, 1, correlation->columns, correlation->along_x);
    read_axis(of, (size_t)of->width, correlation->rows, correlation->along_y);
    return WEFT_OK;
}

weft_code weft_tile_correlate(const weft_tile_pictures *pictures, weft_tile_correlation *correlation, weft_error *error)
{
    spectra of = {.width = weft_fourier_size(2 * pictures->width), .height = weft_fourier_size(2 * pictures->height)};
    *correlation = (weft_tile_correlation){.columns = pictures->width, .rows = pictures->height};
    correlation->along_x = calloc((size_t)pictures->width, sizeof *correlation->along_x);
    correlation->along_y = calloc((size_t)pictures->height, sizeof *correlation->along_y);
    of.transform = malloc(2 * spectrum_size(&of) * sizeof *of.transform);
    of.value_power = calloc(2 * spectrum_size(&of), sizeof *of.value_power);
    of.mask_power = calloc(2 * spectrum_size(&of), sizeof *of.mask_power);
    weft_code code;
    if (correlation->along_x && correlation->along_y && of.transform && of.value_power && of.mask_power)
        code = correlate(pictures, &of, correlation, error);
    else
        code = weft_fail_memory(error, "spectra", 6 * spectrum_size(&of) * sizeof *of.transform);
    free(of.transform);
    free(of.value_power);
    free(of.mask_power);
    if (code != WEFT_OK)
        weft_tile_correlation_free(correlation);
    return code;
}

void weft_tile_correlation_free(weft_tile_correlation *correlation)
{
    free(correlation->along_x);
    free(correlation->along_y);
    *correlation = (weft_tile_correlation){0};
}
