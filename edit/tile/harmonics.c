/* The period whose harmonics explain most of the pictures, for any width and height, not only those of a discrete
 * transform. The waves along each axis are made orthonormal over the texels there are, so that what the pictures owe to
 * one is not counted for another where the material holds no whole number of tiles: a least-squares fit of the Fourier
 * series of the tile, exact where nothing is masked: masked texels count as what stands for them. */
#include "edit/tile/search_steps.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_HARMONICS = 8, MOST_WAVES = 2 * MOST_HARMONICS + 1 };

static const double least_wavelength = 3;

/* A constant, then cosines and sines of the harmonics, orthonormal. */
typedef struct wave_basis {
    int texels, count;
    double (*at)[MOST_WAVES]; /* [texels] */
} wave_basis;

typedef struct fourier_series {
    const weft_tile_pictures *pictures;
    double width, height;
    wave_basis along_x, along_y;
    double *energy; /* [pictures->count] */
} fourier_series;

static double product(const wave_basis *basis, int a, int b)
{
    double sum = 0;
    for (int i = 0; i < basis->texels; i++)
        sum += basis->at[i][a] * basis->at[i][b];
    return sum;
}

/* Takes the part of the waves before it out of a wave and gives it length 1. */
static void make_orthonormal(wave_basis *basis, int wave)
{
    for (int other = 0; other < wave; other++) {
        double share = product(basis, wave, other);
        for (int i = 0; i < basis->texels; i++)
            basis->at[i][wave] -= share * basis->at[i][other];
    }
    double length = sqrt(product(basis, wave, wave));
    for (int i = 0; i < basis->texels; i++)
        basis->at[i][wave] = length > 0 ? basis->at[i][wave] / length : 0;
}

static void set_period(wave_basis *basis, double period)
{
    for (int wave = 0; wave < basis->count; wave++) {
        int harmonic = (wave + 1) / 2;
        for (int i = 0; i < basis->texels; i++) {
            double angle = 2 * (double)WEFT_PI * harmonic * (i + 0.5) / period;
            basis->at[i][wave] = wave % 2 == 1 ? sin(angle) : cos(angle);
        }
        make_orthonormal(basis, wave);
    }
}

/* What the series explains of one picture, its mean left out. */
static double energy_of(const fourier_series *series, int picture)
{
    const weft_tile_pictures *pictures = series->pictures;
    double sum[MOST_WAVES][MOST_WAVES] = {0}, energy = 0;
    for (int y = 0; y < pictures->height; y++) {
        double row[MOST_WAVES] = {0};
        size_t first = ((size_t)picture * (size_t)pictures->height + (size_t)y) * (size_t)pictures->width;
        for (int x = 0; x < pictures->width; x++)
            for (int k = 0; k < series->along_x.count; k++)
                row[k] += (double)pictures->value[first + (size_t)x] * series->along_x.at[x][k];
        for (int k = 0; k < series->along_x.count; k++)
            for (int l = 0; l < series->along_y.count; l++)
                sum[k][l] += row[k] * series->along_y.at[y][l];
    }
    for (int k = 0; k < series->along_x.count; k++)
        for (int l = k == 0; l < series->along_y.count; l++)
            energy += sum[k][l] * sum[k][l];
    return energy;
}

static double total_energy(fourier_series *series)
{
    double sum = 0;
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k < series->pictures->count; k++)
        series->energy[k] = energy_of(series, k);
    for (int k = 0; k < series->pictures->count; k++)
        sum += series->energy[k];
    return sum;
}

static double energy_with_width(void *context, double width)
{
    fourier_series *series = context;
    set_period(&series->along_x, width);
    return total_energy(series);
}

static double energy_with_height(void *context, double height)
{
    fourier_series *series = context;
    set_period(&series->along_y, height);
    return total_energy(series);
}

/* A change of the size by `reach` moves the far end of the material by a texel. */
static void maximise(fourier_series *series)
{
    const weft_tile_pictures *pictures = series->pictures;
    double reach_x = series->width / pictures->width, reach_y = series->height / pictures->height;
    set_period(&series->along_y, series->height);
    for (int round = 0; round < 2; round++) {
        series->width = weft_golden_section(energy_with_width, series, series->width - reach_x, series->width + reach_x,
                                            0.004 * reach_x);
        set_period(&series->along_x, series->width);
        series->height = weft_golden_section(energy_with_height, series, series->height - reach_y,
                                             series->height + reach_y, 0.004 * reach_y);
        set_period(&series->along_y, series->height);
    }
}

static wave_basis waves_of(int texels, double period)
{
    int harmonics = (int)fmax(1, fmin(period / least_wavelength, MOST_HARMONICS));
    wave_basis result = {.texels = texels, .count = 1 + 2 * harmonics};
    result.at = malloc((size_t)texels * sizeof *result.at);
    return result;
}

weft_code weft_tile_period_refine(const weft_tile_pictures *pictures, weft_tile *tile, weft_error *error)
{
    fourier_series series = {.pictures = pictures, .width = tile->width, .height = tile->height};
    series.energy = calloc((size_t)pictures->count, sizeof *series.energy);
    series.along_x = waves_of(pictures->width, tile->width);
    series.along_y = waves_of(pictures->height, tile->height);
    weft_code code = WEFT_OK;
    if (series.energy && series.along_x.at && series.along_y.at) {
        maximise(&series);
        tile->width = series.width;
        tile->height = series.height;
    } else {
        code = weft_fail_memory(error, "waves", (size_t)pictures->width * sizeof *series.along_x.at);
    }
    free(series.energy);
    free(series.along_x.at);
    free(series.along_y.at);
    return code;
}

/* ---- Golden section ---- */

double weft_golden_section(double (*function)(void *context, double x), void *context, double low, double high,
                           double tolerance)
{
    const double golden = (sqrt(5) - 1) / 2;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double at_a = function(context, a), at_b = function(context, b);
    while (high - low > tolerance) {
        if (at_a > at_b) {
            high = b, b = a, at_b = at_a;
            a = high - golden * (high - low);
            at_a = function(context, a);
        } else {
            low = a, a = b, at_a = at_b;
            b = low + golden * (high - low);
            at_b = function(context, b);
        }
    }
    return (low + high) / 2;
}
