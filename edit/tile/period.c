/* The shortest repeat of a material, from the peaks of its autocorrelation.
 *
 * That is computed by the theorem of Wiener and Khinchin, padded so that it does not wrap, of the values and of the
 * masks: their quotient is the mean product of the pairs that are both valid (Padfield 2012). */
#include "edit/tile/search_steps.h"

#include "base/numeric/repeat.h"
#include "edit/tile/fourier.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* ---- Autocorrelation ---- */

/* Along one axis: lag 0, 1, .. of an even lag along the other of 0. */
typedef struct autocorrelation {
    int columns, rows;
    double *along_x, *along_y; /* [columns], [rows] 1 at lag 0; lags whose overlap is more than a quarter, else 0 */
} autocorrelation;

typedef struct padded_spectra {
    int width, height;                /* padded */
    double *transform;                /* [height][width][2] of one picture */
    double *value_power, *mask_power; /* [height][width][2] sums over the pictures, imaginary part 0 */
} padded_spectra;

static size_t spectrum_size(const padded_spectra *spectra)
{
    return (size_t)spectra->width * (size_t)spectra->height;
}

/* The value of picture k where it is valid, or whether it is. */
static double texel(const weft_tile_pictures *pictures, int k, int x, int y, bool is_mask)
{
    size_t i = ((size_t)k * (size_t)pictures->height + (size_t)y) * (size_t)pictures->width + (size_t)x;
    return pictures->mask[i] ? 0 : is_mask ? 1 : (double)pictures->value[i];
}

static weft_code add_power(const weft_tile_pictures *pictures, int k, bool is_mask, padded_spectra *spectra,
                           weft_error *error)
{
    double *power = is_mask ? spectra->mask_power : spectra->value_power;
    memset(spectra->transform, 0, 2 * spectrum_size(spectra) * sizeof *spectra->transform);
    for (int y = 0; y < pictures->height; y++)
        for (int x = 0; x < pictures->width; x++)
            spectra->transform[2 * ((size_t)y * (size_t)spectra->width + (size_t)x)] =
                texel(pictures, k, x, y, is_mask);
    WEFT_TRY(weft_fourier_transform(spectra->transform, spectra->width, spectra->height, 0, error));
    for (size_t i = 0; i < spectrum_size(spectra); i++)
        power[2 * i] += spectra->transform[2 * i] * spectra->transform[2 * i] +
                        spectra->transform[2 * i + 1] * spectra->transform[2 * i + 1];
    return WEFT_OK;
}

/* Mean product at lags 0, stride, 2 stride, .. of the padded arrays, relative to lag 0. */
static void read_axis(const padded_spectra *spectra, size_t stride, int count, double *along)
{
    double variance = spectra->value_power[0] / spectra->mask_power[0];
    for (int i = 0; i < count; i++) {
        size_t at = 2 * stride * (size_t)i;
        bool enough = 4 * spectra->mask_power[at] > spectra->mask_power[0];
        along[i] = enough && variance > 0 ? spectra->value_power[at] / spectra->mask_power[at] / variance : 0;
    }
}

static weft_code correlate(const weft_tile_pictures *pictures, padded_spectra *spectra, autocorrelation *correlation,
                           weft_error *error)
{
    for (int k = 0; k < pictures->count; k++) {
        WEFT_TRY(add_power(pictures, k, false, spectra, error));
        WEFT_TRY(add_power(pictures, k, true, spectra, error));
    }
    WEFT_TRY(weft_fourier_transform(spectra->value_power, spectra->width, spectra->height, 1, error));
    WEFT_TRY(weft_fourier_transform(spectra->mask_power, spectra->width, spectra->height, 1, error));
    read_axis(spectra, 1, correlation->columns, correlation->along_x);
    read_axis(spectra, (size_t)spectra->width, correlation->rows, correlation->along_y);
    return WEFT_OK;
}

static void free_autocorrelation(autocorrelation *correlation)
{
    free(correlation->along_x);
    free(correlation->along_y);
    *correlation = (autocorrelation){0};
}

static weft_code autocorrelate(const weft_tile_pictures *pictures, autocorrelation *correlation, weft_error *error)
{
    padded_spectra spectra = {.width = weft_fourier_size(2 * pictures->width),
                              .height = weft_fourier_size(2 * pictures->height)};
    *correlation = (autocorrelation){.columns = pictures->width, .rows = pictures->height};
    correlation->along_x = calloc((size_t)pictures->width, sizeof *correlation->along_x);
    correlation->along_y = calloc((size_t)pictures->height, sizeof *correlation->along_y);
    spectra.transform = malloc(2 * spectrum_size(&spectra) * sizeof *spectra.transform);
    spectra.value_power = calloc(2 * spectrum_size(&spectra), sizeof *spectra.value_power);
    spectra.mask_power = calloc(2 * spectrum_size(&spectra), sizeof *spectra.mask_power);
    weft_code code;
    if (correlation->along_x && correlation->along_y && spectra.transform && spectra.value_power && spectra.mask_power)
        code = correlate(pictures, &spectra, correlation, error);
    else
        code = weft_fail_memory(error, "spectra", 6 * spectrum_size(&spectra) * sizeof *spectra.transform);
    free(spectra.transform);
    free(spectra.value_power);
    free(spectra.mask_power);
    if (code != WEFT_OK)
        free_autocorrelation(correlation);
    return code;
}

/* ---- Its peaks ---- */

/* The highest peak within a texel and a half of where a multiple should be, or 0. */
static double peak_near(const double *along, int count, double lag)
{
    int best = 0;
    for (int i = (int)ceil(lag - 1.5); i <= (int)floor(lag + 1.5); i++)
        if (i > 0 && i + 1 < count && weft_repeat_is_peak(along, i) && (best == 0 || along[i] > along[best]))
            best = i;
    return best > 0 ? weft_repeat_vertex(along, best) : 0;
}

/* The period from ever larger multiples: each doubling halves its error. */
static double sharpen(const double *along, int count, double period)
{
    for (int n = 2; n * period < 0.7 * count; n *= 2) {
        double found = peak_near(along, count, n * period);
        if (!(found > 0))
            return period;
        period = found / n;
    }
    return period;
}

static weft_code find_axis(const double *along, int count, const char *axis, const char *path, double *period,
                           double *repeat, weft_error *error)
{
    int lag = weft_repeat_first(along, count);
    if (lag == 0)
        return weft_fail(
            error, WEFT_BAD_INPUT,
            "'%s' does not repeat along %s: over its %d texels at least two tiles must fit, each correlated "
            "with the next by more than %g",
            path, axis, count, WEFT_LEAST_REPEAT);
    *repeat = along[lag];
    *period = sharpen(along, count, weft_repeat_vertex(along, lag));
    return WEFT_OK;
}

weft_code weft_tile_period_find(const weft_tile_pictures *pictures, const char *path, weft_tile_report *report,
                                weft_error *error)
{
    autocorrelation correlation;
    WEFT_TRY(autocorrelate(pictures, &correlation, error));
    weft_tile *tile = &report->tile;
    weft_code code =
        find_axis(correlation.along_x, correlation.columns, "u", path, &tile->width, &report->repeat_x, error);
    if (code == WEFT_OK)
        code = find_axis(correlation.along_y, correlation.rows, "v", path, &tile->height, &report->repeat_y, error);
    free_autocorrelation(&correlation);
    return code;
}
