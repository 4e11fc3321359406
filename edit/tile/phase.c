#include "edit/tile/search_steps.h"

#include "edit/tile/fourier.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double least_likeness = 0.3;

/* A longer tile must look this much more like the weave than a shorter one. */
static const double clearly_better = 0.02;

enum { MOST_REPEATS = 3, SAMPLES = 3 };

/* One supposition about how large the tile is. */
typedef struct tile_matching {
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
} tile_matching;

static size_t texel_count(const tile_matching *matching)
{
    return (size_t)matching->columns * (size_t)matching->rows;
}

/* ---- The weave under the light and view of a picture ---- */

/* Mean over a texel of the tile and over the channels. */
static double rendered_texel(const tile_matching *matching, int column, int row, weft_vec3 light, weft_vec3 view)
{
    double sum = 0;
    for (int i = 0; i < SAMPLES * SAMPLES; i++) {
        double u = (column + (i % SAMPLES + 0.5) / SAMPLES) / matching->columns;
        double v = 1 - (row + (i / SAMPLES + 0.5) / SAMPLES) / matching->rows;
        weft_weave_point point = weft_weave_locate(matching->weave, (weft_real)u, (weft_real)v, 0);
        weft_rgb value = weft_weave_brdf(matching->weave, &point, light, view);
        sum += (double)(value.r + value.g + value.b);
    }
    return sum;
}

/* Relative to the mean over the tile, less 1, as the pictures are. */
static void render(tile_matching *matching, int image)
{
    weft_vec3 light = matching->layout->light[image],
              view = matching->layout->view[matching->layout->view_of_image[image]];
    double sum = 0;
#pragma omp parallel for reduction(+ : sum)
    for (int row = 0; row < matching->rows; row++) {
        for (int column = 0; column < matching->columns; column++) {
            double value = rendered_texel(matching, column, row, light, view);
            size_t i = 2 * ((size_t)row * (size_t)matching->columns + (size_t)column);
            matching->rendered[i] = value;
            matching->rendered[i + 1] = 0;
            sum += value;
        }
    }
    double mean = sum / (double)texel_count(matching);
    for (size_t i = 0; i < texel_count(matching); i++) {
        double value = mean > 0 ? matching->rendered[2 * i] / mean - 1 : 0;
        matching->rendered[2 * i] = value;
        matching->rendered_energy += value * value;
    }
}

/* The mean tile of a picture, less its own mean. */
static void average(tile_matching *matching, int k)
{
    double sum = 0;
    weft_tile_mean_make(matching->pictures, k, &matching->tile, &matching->mean);
    for (size_t i = 0; i < texel_count(matching); i++)
        sum += matching->mean.sum[i];
    for (size_t i = 0; i < texel_count(matching); i++) {
        double value = matching->mean.sum[i] - sum / (double)texel_count(matching);
        matching->found[2 * i] = value;
        matching->found[2 * i + 1] = 0;
        matching->found_energy += value * value;
    }
}

/* ---- Their correlation ---- */

static weft_code add_picture(tile_matching *matching, int k, weft_error *error)
{
    average(matching, k);
    render(matching, matching->pictures->image[k]);
    WEFT_TRY(weft_fourier_transform(matching->found, matching->columns, matching->rows, 0, error));
    WEFT_TRY(weft_fourier_transform(matching->rendered, matching->columns, matching->rows, 0, error));
    for (size_t i = 0; i < 2 * texel_count(matching); i += 2) {
        const double *a = matching->found + i, *b = matching->rendered + i;
        matching->cross[i] += a[0] * b[0] + a[1] * b[1];
        matching->cross[i + 1] += a[1] * b[0] - a[0] * b[1];
    }
    return WEFT_OK;
}

static double signed_frequency(int index, int count)
{
    return 2 * index <= count ? index : index - count;
}

/* The correlation surface at a shift between texels: its trigonometric interpolant. */
static double correlation_at(const tile_matching *matching, double shift_x, double shift_y)
{
    double sum = 0;
    for (int row = 0; row < matching->rows; row++) {
        double turn_y = signed_frequency(row, matching->rows) * shift_y / matching->rows;
        for (int column = 0; column < matching->columns; column++) {
            const double *cross = matching->cross + 2 * ((size_t)row * (size_t)matching->columns + (size_t)column);
            double angle =
                2 * WEFT_PI * (turn_y + signed_frequency(column, matching->columns) * shift_x / matching->columns);
            sum += cross[0] * cos(angle) - cross[1] * sin(angle);
        }
    }
    return sum / (double)texel_count(matching);
}

static double correlation_along_x(void *context, double shift)
{
    const tile_matching *matching = context;
    return correlation_at(matching, shift, matching->shift_y);
}

static double correlation_along_y(void *context, double shift)
{
    const tile_matching *matching = context;
    return correlation_at(matching, matching->shift_x, shift);
}

/* The highest point of the correlation surface; the result is the likeness there. */
static double find_shift(tile_matching *matching)
{
    const double tolerance = 1e-3;
    size_t best = 0;
    for (size_t i = 0; i < texel_count(matching); i++)
        best = matching->surface[2 * i] > matching->surface[2 * best] ? i : best;
    matching->shift_x = (double)(best % (size_t)matching->columns);
    matching->shift_y = (double)(best / (size_t)matching->columns);
    for (int round = 0; round < 2; round++) {
        matching->shift_x =
            weft_golden_section(correlation_along_x, matching, matching->shift_x - 1, matching->shift_x + 1, tolerance);
        matching->shift_y =
            weft_golden_section(correlation_along_y, matching, matching->shift_y - 1, matching->shift_y + 1, tolerance);
    }
    double energy = sqrt(matching->found_energy * matching->rendered_energy);
    return energy > 0 ? correlation_at(matching, matching->shift_x, matching->shift_y) / energy : 0;
}

static weft_code match(tile_matching *matching, double *likeness, weft_error *error)
{
    for (int k = 0; k < matching->pictures->count; k++)
        WEFT_TRY(add_picture(matching, k, error));
    memcpy(matching->surface, matching->cross, 2 * texel_count(matching) * sizeof *matching->surface);
    WEFT_TRY(weft_fourier_transform(matching->surface, matching->columns, matching->rows, 1, error));
    *likeness = find_shift(matching);
    return WEFT_OK;
}

/* ---- Which multiple of the shortest repeat ---- */

static void free_matching(tile_matching *matching)
{
    weft_tile_mean_free(&matching->mean);
    free(matching->found);
    free(matching->rendered);
    free(matching->cross);
    free(matching->surface);
}

/* Supposes the tile of `of`; `likeness` and the place of the tile are the result. */
static weft_code suppose(tile_matching *matching, double *likeness, weft_error *error)
{
    matching->columns = (int)lround(matching->tile.width);
    matching->rows = (int)lround(matching->tile.height);
    WEFT_TRY(weft_tile_mean_create(matching->pictures, matching->columns, matching->rows, &matching->mean, error));
    size_t values = 2 * texel_count(matching);
    matching->found = malloc(values * sizeof *matching->found);
    matching->rendered = malloc(values * sizeof *matching->rendered);
    matching->cross = calloc(values, sizeof *matching->cross);
    matching->surface = malloc(values * sizeof *matching->surface);
    weft_code code = WEFT_OK;
    if (!matching->found || !matching->rendered || !matching->cross || !matching->surface)
        code = weft_fail_memory(error, "correlation with the weave", 4 * values * sizeof *matching->found);
    if (code == WEFT_OK)
        code = match(matching, likeness, error);
    free_matching(matching);
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
        tile_matching matching = {.pictures = pictures, .layout = layout, .weave = weave, .tile = tile};
        double likeness = 0;
        WEFT_TRY(suppose(&matching, &likeness, error));
        if (report->likeness >= 0 && likeness < report->likeness + clearly_better)
            continue;
        report->likeness = likeness;
        report->tile = tile;
        report->tile.left = wrapped(matching.shift_x * tile.width / matching.columns, tile.width);
        report->tile.top = wrapped(matching.shift_y * tile.height / matching.rows, tile.height);
    }
    if (report->likeness < least_likeness)
        return weft_fail(
            error, WEFT_BAD_INPUT,
            "'%s' does not look like the weave '%s': its repeat of %.2f x %.2f texels has a correlation of "
            "%.2f with it, at least %g is wanted",
            path, weave->name, repeat.width, repeat.height, report->likeness, least_likeness);
    return WEFT_OK;
}
