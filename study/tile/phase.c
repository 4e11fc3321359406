#include "study/tile/phase.h"

#include "study/tile/fourier.h"
#include "study/tile/golden_section.h"
#include "study/tile/mean.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double least_likeness = 0.3;

/* A longer tile must look this much more like the weave than a shorter one. */
static const double clearly_better = 0.02;

enum { MOST_REPEATS = 3, SAMPLES = 3 };

/* One supposition about how large the tile is. */
typedef struct matching {
    const weft_tile_pictures *pictures;
    const weft_dataset_layout *layout;
    const weft_weave *weave;
    weft_tile tile;
    int columns, rows;
    weft_tile_mean mean;
    double *found, *rendered; /* [rows][columns][2] mean tile of a picture, the weave; then their transforms */
    double *cross;            /* [rows][columns][2] sum over the pictures of found times the conjugate of rendered */
    double *surface;          /* [rows][columns][2] its inverse transform */
    double found_energy, rendered_energy;
    double shift_x, shift_y; /* of the best match, texels of the tile */
} matching;

static size_t texel_count(const matching *of)
{
    return (size_t)of->columns * (size_t)of->rows;
}

/* ---- The weave under the light and view of a picture ---- */

/* Mean over a texel of the tile and over the channels. */
static double rendered_texel(const matching *of, int column, int row, weft_vec3 light, weft_vec3 view)
{
    double sum = 0;
    for (int i = 0; i < SAMPLES * SAMPLES; i++) {
        double u = (column + (i % SAMPLES + 0.5) / SAMPLES) / of->columns;
        double v = 1 - (row + (i / SAMPLES + 0.5) / SAMPLES) / of->rows;
        weft_weave_point point = weft_weave_locate(of->weave, (weft_real)u, (weft_real)v, 0);
        weft_rgb value = weft_weave_brdf(of->weave, &point, light, view);
        sum += (double)(value.r + value.g + value.b);
    }
    return sum;
}

/* Relative to the mean over the tile, less 1, as the pictures are. */
static void render(matching *of, int image)
{
    weft_vec3 light = of->layout->light[image], view = of->layout->view[of->layout->view_of_image[image]];
    double sum = 0;
#pragma omp parallel for reduction(+ : sum)
    for (int row = 0; row < of->rows; row++) {
        for (int column = 0; column < of->columns; column++) {
            double value = rendered_texel(of, column, row, light, view);
            size_t i = 2 * ((size_t)row * (size_t)of->columns + (size_t)column);
            of->rendered[i] = value;
            of->rendered[i + 1] = 0;
            sum += value;
        }
    }
    double mean = sum / (double)texel_count(of);
    for (size_t i = 0; i < texel_count(of); i++) {
        double value = mean > 0 ? of->rendered[2 * i] / mean - 1 : 0;
        of->rendered[2 * i] = value;
        of->rendered_energy += value * value;
    }
}

/* The mean tile of a picture, less its own mean. */
static void average(matching *of, int k)
{
    double sum = 0;
    weft_tile_mean_make(of->pictures, k, &of->tile, &of->mean);
    for (size_t i = 0; i < texel_count(of); i++)
        sum += of->mean.sum[i];
    for (size_t i = 0; i < texel_count(of); i++) {
        double value = of->mean.sum[i] - sum / (double)texel_count(of);
        of->found[2 * i] = value;
        of->found[2 * i + 1] = 0;
        of->found_energy += value * value;
    }
}

/* ---- Their correlation ---- */

static weft_code add_picture(matching *of, int k, weft_error *error)
{
    average(of, k);
    render(of, of->pictures->image[k]);
    WEFT_TRY(weft_fourier_transform(of->found, of->columns, of->rows, 0, error));
    WEFT_TRY(weft_fourier_transform(of->rendered, of->columns, of->rows, 0, error));
    for (size_t i = 0; i < 2 * texel_count(of); i += 2) {
        const double *a = of->found + i, *b = of->rendered + i;
        of->cross[i] += a[0] * b[0] + a[1] * b[1];
        of->cross[i + 1] += a[1] * b[0] - a[0] * b[1];
    }
    return WEFT_OK;
}

static double signed_frequency(int index, int count)
{
    return 2 * index <= count ? index : index - count;
}

/* The correlation surface at a shift between texels: its trigonometric interpolant. */
static double correlation_at(const matching *of, double shift_x, double shift_y)
{
    double sum = 0;
    for (int row = 0; row < of->rows; row++) {
        double turn_y = signed_frequency(row, of->rows) * shift_y / of->rows;
        for (int column = 0; column < of->columns; column++) {
            const double *cross = of->cross + 2 * ((size_t)row * (size_t)of->columns + (size_t)column);
            double angle = 2 * WEFT_PI * (turn_y + signed_frequency(column, of->columns) * shift_x / of->columns);
            sum += cross[0] * cos(angle) - cross[1] * sin(angle);
        }
    }
    return sum / (double)texel_count(of);
}

static double correlation_along_x(void *context, double shift)
{
    const matching *of = context;
    return correlation_at(of, shift, of->shift_y);
}

static double correlation_along_y(void *context, double shift)
{
    const matching *of = context;
    return correlation_at(of, of->shift_x, shift);
}

/* The highest point of the correlation surface; the result is the likeness there. */
static double find_shift(matching *of)
{
    const double tolerance = 1e-3;
    size_t best = 0;
    for (size_t i = 0; i < texel_count(of); i++)
        best = of->surface[2 * i] > of->surface[2 * best] ? i : best;
    of->shift_x = (double)(best % (size_t)of->columns);
    of->shift_y = (double)(best / (size_t)of->columns);
    for (int round = 0; round < 2; round++) {
        of->shift_x = weft_golden_section(correlation_along_x, of, of->shift_x - 1, of->shift_x + 1, tolerance);
        of->shift_y = weft_golden_section(correlation_along_y, of, of->shift_y - 1, of->shift_y + 1, tolerance);
    }
    double energy = sqrt(of->found_energy * of->rendered_energy);
    return energy > 0 ? correlation_at(of, of->shift_x, of->shift_y) / energy : 0;
}

static weft_code match(matching *of, double *likeness, weft_error *error)
{
    for (int k = 0; k < of->pictures->count; k++)
        WEFT_TRY(add_picture(of, k, error));
    memcpy(of->surface, of->cross, 2 * texel_count(of) * sizeof *of->surface);
    WEFT_TRY(weft_fourier_transform(of->surface, of->columns, of->rows, 1, error));
    *likeness = find_shift(of);
    return WEFT_OK;
}

/* ---- Which multiple of the shortest repeat ---- */

static void free_matching(matching *of)
{
    weft_tile_mean_free(&of->mean);
    free(of->found);
    free(of->rendered);
    free(of->cross);
    free(of->surface);
}

/* Supposes the tile of `of`; `likeness` and the place of the tile are the result. */
static weft_code suppose(matching *of, double *likeness, weft_error *error)
{
    of->columns = (int)lround(of->tile.width);
    of->rows = (int)lround(of->tile.height);
    WEFT_TRY(weft_tile_mean_create(of->pictures, of->columns, of->rows, &of->mean, error));
    size_t values = 2 * texel_count(of);
    of->found = malloc(values * sizeof *of->found);
    of->rendered = malloc(values * sizeof *of->rendered);
    of->cross = calloc(values, sizeof *of->cross);
    of->surface = malloc(values * sizeof *of->surface);
    weft_code code = WEFT_OK;
    if (!of->found || !of->rendered || !of->cross || !of->surface)
        code = weft_fail_memory(error, "correlation with the weave", 4 * values * sizeof *of->found);
    if (code == WEFT_OK)
        code = match(of, likeness, error);
    free_matching(of);
    return code;
}

/* 0 <= result < period. */
static double wrapped(double at, double period)
{
    double result = at - period * floor(at / period);
    return result < period ? result : 0;
}

weft_code weft_tile_phase_find(const weft_tile_pictures *pictures, const weft_dataset_layout *layout, const char *path,
                               const weft_weave *weave, weft_tile_report *report, weft_error *error)
{
    weft_tile repeat = report->tile;
    report->likeness = -1;
    for (int i = 0; i < MOST_REPEATS * MOST_REPEATS; i++) {
        weft_tile tile = {.width = repeat.width * (1 + i % MOST_REPEATS),
                          .height = repeat.height * (1 + i / MOST_REPEATS)};
        if (tile.width > layout->width || tile.height > layout->height)
            continue;
        matching of = {.pictures = pictures, .layout = layout, .weave = weave, .tile = tile};
        double likeness = 0;
        WEFT_TRY(suppose(&of, &likeness, error));
        if (report->likeness >= 0 && likeness < report->likeness + clearly_better)
            continue;
        report->likeness = likeness;
        report->tile = tile;
        report->tile.left = wrapped(of.shift_x * tile.width / of.columns, tile.width);
        report->tile.top = wrapped(of.shift_y * tile.height / of.rows, tile.height);
    }
    if (report->likeness < least_likeness)
        return weft_fail(
            error, WEFT_BAD_INPUT,
            "'%s' does not look like the weave '%s': its repeat of %.2f x %.2f texels has a correlation of "
            "%.2f with it, at least %g is wanted",
            path, weave->name, repeat.width, repeat.height, report->likeness, least_likeness);
    return WEFT_OK;
}
