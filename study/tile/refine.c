/* The period whose harmonics explain most of the pictures, for any width and height, not only those of a discrete
 * transform. The waves along each axis are made orthonormal over the texels there are, so that what the pictures owe to
 * one is not counted for another where the material holds no whole number of tiles: a least-squares fit of the Fourier
 * series of the tile, exact where nothing is masked: masked texels count as what stands for them. */
#include "study/tile/golden_section.h"
#include "study/tile/period.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_HARMONICS = 8, MOST_WAVES = 2 * MOST_HARMONICS + 1 };

static const double least_wavelength = 3;

/* A constant, then cosines and sines of the harmonics, orthonormal. */
typedef struct waves {
    int texels, count;
    double (*at)[MOST_WAVES]; /* [texels] */
} waves;

typedef struct series {
    const weft_tile_pictures *pictures;
    double width, height;
    waves along_x, along_y;
    double *energy; /* [pictures->count] */
} series;

static double product(const waves *of, int a, int b)
{
    double sum = 0;
    for (int i = 0; i < of->texels; i++)
        sum += of->at[i][a] * of->at[i][b];
    return sum;
}

/* Takes the part of the waves before it out of a wave and gives it length 1. */
static void make_orthonormal(waves *of, int wave)
{
    for (int other = 0; other < wave; other++) {
        double share = product(of, wave, other);
        for (int i = 0; i < of->texels; i++)
            of->at[i][wave] -= share * of->at[i][other];
    }
    double length = sqrt(product(of, wave, wave));
    for (int i = 0; i < of->texels; i++)
        of->at[i][wave] = length > 0 ? of->at[i][wave] / length : 0;
}

static void set_period(waves *of, double period)
{
    for (int wave = 0; wave < of->count; wave++) {
        int harmonic = (wave + 1) / 2;
        for (int i = 0; i < of->texels; i++) {
            double angle = 2 * (double)WEFT_PI * harmonic * (i + 0.5) / period;
            of->at[i][wave] = wave % 2 == 1 ? sin(angle) : cos(angle);
        }
        make_orthonormal(of, wave);
    }
}

/* What the series explains of one picture, its mean left out. */
static double energy_of(const series *of, int picture)
{
    const weft_tile_pictures *pictures = of->pictures;
    double sum[MOST_WAVES][MOST_WAVES] = {0}, energy = 0;
    for (int y = 0; y < pictures->height; y++) {
        double row[MOST_WAVES] = {0};
        size_t first = ((size_t)picture * (size_t)pictures->height + (size_t)y) * (size_t)pictures->width;
        for (int x = 0; x < pictures->width; x++)
            for (int k = 0; k < of->along_x.count; k++)
                row[k] += (double)pictures->value[first + (size_t)x] * of->along_x.at[x][k];
        for (int k = 0; k < of->along_x.count; k++)
            for (int l = 0; l < of->along_y.count; l++)
                sum[k][l] += row[k] * of->along_y.at[y][l];
    }
    for (int k = 0; k < of->along_x.count; k++)
        for (int l = k == 0; l < of->along_y.count; l++)
            energy += sum[k][l] * sum[k][l];
    return energy;
}

static double total_energy(series *of)
{
    double sum = 0;
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k < of->pictures->count; k++)
        of->energy[k] = energy_of(of, k);
    for (int k = 0; k < of->pictures->count; k++)
        sum += of->energy[k];
    return sum;
}

static double energy_with_width(void *context, double width)
{
    series *of = context;
    set_period(&of->along_x, width);
    return total_energy(of);
}

static double energy_with_height(void *context, double height)
{
    series *of = context;
    set_period(&of->along_y, height);
    return total_energy(of);
}

/* A change of the size by `reach` moves the far end of the material by a texel. */
static void maximise(series *of)
{
    const weft_tile_pictures *pictures = of->pictures;
    double reach_x = of->width / pictures->width, reach_y = of->height / pictures->height;
    set_period(&of->along_y, of->height);
    for (int round = 0; round < 2; round++) {
        of->width =
            weft_golden_section(energy_with_width, of, of->width - reach_x, of->width + reach_x, 0.004 * reach_x);
        set_period(&of->along_x, of->width);
        of->height =
            weft_golden_section(energy_with_height, of, of->height - reach_y, of->height + reach_y, 0.004 * reach_y);
        set_period(&of->along_y, of->height);
    }
}

static waves waves_of(int texels, double period)
{
    int harmonics = (int)fmax(1, fmin(period / least_wavelength, MOST_HARMONICS));
    waves result = {.texels = texels, .count = 1 + 2 * harmonics};
    result.at = malloc((size_t)texels * sizeof *result.at);
    return result;
}

weft_code weft_tile_period_refine(const weft_tile_pictures *pictures, weft_tile *tile, weft_error *error)
{
    series of = {.pictures = pictures, .width = tile->width, .height = tile->height};
    of.energy = calloc((size_t)pictures->count, sizeof *of.energy);
    of.along_x = waves_of(pictures->width, tile->width);
    of.along_y = waves_of(pictures->height, tile->height);
    weft_code code = WEFT_OK;
    if (of.energy && of.along_x.at && of.along_y.at) {
        maximise(&of);
        tile->width = of.width;
        tile->height = of.height;
    } else {
        code = weft_fail_memory(error, "waves", (size_t)pictures->width * sizeof *of.along_x.at);
    }
    free(of.energy);
    free(of.along_x.at);
    free(of.along_y.at);
    return code;
}
