#include "relief/height_map.h"

#include "base/integers.h"
#include "base/numeric/repeat.h"
#include "base/numeric/statistics.h"
#include "relief/sweep.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Costs over all heights on the grid. */
typedef struct cost_volume {
    int width, height, step_count;
    bool repeats;
    float *cost; /* [step_count][height][width] */
    float *best; /* [height][width] heights, in steps */
} cost_volume;

static void free_volume(cost_volume *volume)
{
    free(volume->cost);
    free(volume->best);
}

/* ---- Smoothing ---- */

static int neighbour(int index, int count, bool repeats)
{
    if (repeats)
        return (index + count) % count;
    return index < 0 ? 0 : index >= count ? count - 1 : index;
}

/* Five taps of a Gaussian of 0.7 points, along rows (stride 1) or columns. */
static void smooth_line(float *line, int count, size_t stride, bool repeats, float *copy)
{
    static const float tap[3] = {0.5641f, 0.2074f, 0.0106f};
    for (int i = 0; i < count; i++)
        copy[i] = line[(size_t)i * stride];
    for (int i = 0; i < count; i++) {
        float sum = tap[0] * copy[i];
        for (int k = 1; k <= 2; k++)
            sum += tap[k] * (copy[neighbour(i - k, count, repeats)] + copy[neighbour(i + k, count, repeats)]);
        line[(size_t)i * stride] = sum;
    }
}

static weft_code smooth(const cost_volume *volume, weft_error *error)
{
    size_t points = (size_t)volume->width * (size_t)volume->height;
    size_t longest = (size_t)weft_larger(volume->width, volume->height);
    float *copies = malloc((size_t)volume->step_count * longest * sizeof *copies);
    if (!copies)
        return weft_fail_memory(error, "costs", (size_t)volume->step_count * longest * sizeof *copies);
#pragma omp parallel for schedule(dynamic)
    for (int step = 0; step < volume->step_count; step++) {
        float *slice = volume->cost + (size_t)step * points, *copy = copies + (size_t)step * longest;
        for (int y = 0; y < volume->height; y++)
            smooth_line(slice + (size_t)y * (size_t)volume->width, volume->width, 1, volume->repeats, copy);
        for (int x = 0; x < volume->width; x++)
            smooth_line(slice + x, volume->height, (size_t)volume->width, volume->repeats, copy);
    }
    free(copies);
    return WEFT_OK;
}

/* ---- The least cost ---- */

/* Where the parabola through three costs is least, in steps from the middle one. */
static float vertex(float before, float middle, float after)
{
    float curvature = before - 2 * middle + after;
    return curvature > 0 ? 0.5f * (before - after) / curvature : 0;
}

static float best_step(const cost_volume *volume, size_t point, float *confidence)
{
    size_t points = (size_t)volume->width * (size_t)volume->height;
    const float *cost = volume->cost + point;
    int best = 0, last = volume->step_count - 1;
    float sum = 0;
    for (int step = 0; step <= last; step++) {
        sum += cost[(size_t)step * points];
        if (cost[(size_t)step * points] < cost[(size_t)best * points])
            best = step;
    }
    float least = cost[(size_t)best * points];
    *confidence = sum / (float)volume->step_count - least;
    if (best == 0 || best == last)
        return (float)best;
    return (float)best + vertex(cost[(size_t)(best - 1) * points], least, cost[(size_t)(best + 1) * points]);
}

static float median_of_nine(const cost_volume *volume, int x, int y)
{
    float value[9];
    for (int i = 0; i < 9; i++) {
        int column = neighbour(x + i % 3 - 1, volume->width, volume->repeats);
        int row = neighbour(y + i / 3 - 1, volume->height, volume->repeats);
        value[i] = volume->best[(size_t)row * (size_t)volume->width + (size_t)column];
    }
    return weft_quantile_of_floats(value, 9, 0.5);
}

/* ---- A map ---- */

static weft_code create_volume(const weft_height_search *search, cost_volume *volume, weft_error *error)
{
    *volume = (cost_volume){.width = search->features->width * search->scale,
                            .height = search->features->height * search->scale,
                            .step_count = search->step_count,
                            .repeats = search->features->repeats};
    size_t points = (size_t)volume->width * (size_t)volume->height, steps = (size_t)volume->step_count;
    volume->cost = malloc(points * steps * sizeof *volume->cost);
    volume->best = malloc(points * sizeof *volume->best);
    return volume->cost && volume->best ? WEFT_OK : weft_fail_memory(error, "costs of heights", points * steps * 4);
}

/* A black place is one that has less than a thousandth of the mean energy. */
static float least_energy(const weft_features *features)
{
    size_t count = (size_t)features->view_count * (size_t)features->height * (size_t)features->width;
    double sum = 0;
    for (size_t i = 0; i < WEFT_FEATURES * count; i++)
        sum += (double)(features->value[i] * features->value[i]);
    return (float)(1e-3 * sum / (double)count);
}

static weft_code allocate_map(int width, int height, weft_height_map *map, weft_error *error)
{
    size_t texels = (size_t)width * (size_t)height;
    *map =
        (weft_height_map){width, height, calloc(texels, sizeof *map->value), calloc(texels, sizeof *map->confidence)};
    if (map->value && map->confidence)
        return WEFT_OK;
    weft_height_map_free(map);
    return weft_fail_memory(error, "heights", texels * sizeof *map->value);
}

static void fill_map(const cost_volume *volume, const weft_height_search *search, weft_height_map *map)
{
    double step_mm = (search->high - search->low) / (search->step_count - 1);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < volume->height; y++)
        for (int x = 0; x < volume->width; x++)
            map->value[(size_t)y * (size_t)volume->width + (size_t)x] =
                (float)(search->low + step_mm * (double)median_of_nine(volume, x, y));
}

static weft_code find(const weft_height_search *search, cost_volume *volume, weft_height_map *map, weft_error *error)
{
    size_t points = (size_t)volume->width * (size_t)volume->height;
    const weft_sweep sweep = {search->features,   search->view, search->view_count, search->scale,
                              search->step_count, search->low,  search->high,       least_energy(search->features)};
    weft_sweep_run(&sweep, volume->cost);
    WEFT_TRY(smooth(volume, error));
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < points; i++)
        volume->best[i] = best_step(volume, i, &map->confidence[i]);
    fill_map(volume, search, map);
    return WEFT_OK;
}

weft_code weft_height_map_find(const weft_height_search *search, weft_height_map *map, weft_error *error)
{
    cost_volume volume;
    WEFT_TRY(
        allocate_map(search->features->width * search->scale, search->features->height * search->scale, map, error));
    weft_code code = create_volume(search, &volume, error);
    if (code == WEFT_OK)
        code = find(search, &volume, map, error);
    free_volume(&volume);
    if (code != WEFT_OK)
        weft_height_map_free(map);
    return code;
}

void weft_height_map_free(weft_height_map *map)
{
    free(map->value);
    free(map->confidence);
    *map = (weft_height_map){0};
}

weft_code weft_height_map_halve(const weft_height_map *map, weft_height_map *half, weft_error *error)
{
    WEFT_TRY(allocate_map(map->width / 2, map->height / 2, half, error));
    for (int i = 0; i < 4 * half->width * half->height; i++) {
        int x = i % (2 * half->width), y = i / (2 * half->width);
        size_t from = (size_t)y * (size_t)map->width + (size_t)x;
        size_t to = (size_t)(y / 2) * (size_t)half->width + (size_t)(x / 2);
        half->value[to] += map->value[from] / 4;
        half->confidence[to] += map->confidence[from] / 4;
    }
    return WEFT_OK;
}

/* ---- The range ---- */

/* A step of the wide search is two texels at most: further apart, thin yarns are missed. */
enum { WIDE_STEPS = 64, WIDE_TEXELS_A_STEP = 2 };

/* The range of the heights that are at least as confident as the median. */
static weft_code confident_range(const weft_height_map *map, double *low, double *high, weft_error *error)
{
    size_t texels = (size_t)map->width * (size_t)map->height, count = 0;
    float *scratch = malloc(texels * sizeof *scratch);
    if (!scratch)
        return weft_fail_memory(error, "heights", texels * sizeof *scratch);
    memcpy(scratch, map->confidence, texels * sizeof *scratch);
    float least = weft_quantile_of_floats(scratch, texels, 0.5);
    for (size_t i = 0; i < texels; i++)
        if (map->confidence[i] >= least)
            scratch[count++] = map->value[i];
    *low = (double)weft_quantile_of_floats(scratch, count, 0.02);
    *high = (double)weft_quantile_of_floats(scratch, count, 0.98);
    free(scratch);
    return WEFT_OK;
}

static weft_code search_wide(const weft_features *features, const int *view, int view_count, double *low, double *high,
                             weft_error *error)
{
    weft_height_map map;
    const weft_height_search wide = {features, view, view_count, WIDE_STEPS, 1, *low, *high};
    double from = *low, to = *high, step = (to - from) / (WIDE_STEPS - 1);
    WEFT_TRY(weft_height_map_find(&wide, &map, error));
    weft_code code = confident_range(&map, low, high, error);
    weft_height_map_free(&map);
    double margin = 0.15 * (*high - *low) + 1.5 * step;
    *low = fmax(*low - margin, from);
    *high = fmin(*high + margin, to);
    return code;
}

weft_code weft_height_range_find(const weft_features *features, const int *view, int view_count, double *low,
                                 double *high, weft_error *error)
{
    double texel = fmax(features->width_mm / features->width, features->height_mm / features->height);
    if (*high - *low <= WIDE_STEPS * WIDE_TEXELS_A_STEP * texel)
        return search_wide(features, view, view_count, low, high, error);
    weft_features half;
    WEFT_TRY(weft_features_halve(features, &half, error));
    weft_code code = weft_height_range_find(&half, view, view_count, low, high, error);
    weft_features_free(&half);
    return code;
}

/* ---- How far heights are looked for ---- */

enum { REACH_TEXELS = 24 };

static const double stitch_heights = 1.25, side_share = 0.25;

static int steepest_view(const weft_features *features)
{
    int best = 0;
    for (int k = 1; k < features->view_count; k++)
        if (features->direction[k].z > features->direction[best].z)
            best = k;
    return best;
}

/* ---- Autocorrelation ---- */

/* Of the features over all known places of a view. */
typedef struct moments {
    double mean[WEFT_FEATURES], variance;
} moments;

static moments moments_of(const weft_features *features, int view)
{
    moments result = {0};
    double squares = 0;
    long count = 0;
    for (int y = 0; y < features->height; y++) {
        for (int x = 0; x < features->width; x++) {
            const float *at = weft_feature_at(features, view, x, y);
            if (!weft_feature_known(features, view, x, y))
                continue;
            count++;
            for (int k = 0; k < WEFT_FEATURES; k++) {
                result.mean[k] += (double)at[k];
                squares += (double)at[k] * (double)at[k];
            }
        }
    }
    if (count == 0)
        return result;
    result.variance = squares / (double)count;
    for (int k = 0; k < WEFT_FEATURES; k++) {
        result.mean[k] /= (double)count;
        result.variance -= result.mean[k] * result.mean[k];
    }
    return result;
}

/* The mean product of what is known at a lag along x or y, relative to the variance. */
static double correlation_at(const weft_features *features, int view, const moments *m, int lag_x, int lag_y)
{
    double sum = 0;
    long count = 0;
    for (int y = 0; y + lag_y < features->height; y++) {
        for (int x = 0; x + lag_x < features->width; x++) {
            const float *a = weft_feature_at(features, view, x, y);
            const float *b = weft_feature_at(features, view, x + lag_x, y + lag_y);
            if (!weft_feature_known(features, view, x, y) || !weft_feature_known(features, view, x + lag_x, y + lag_y))
                continue;
            count++;
            for (int k = 0; k < WEFT_FEATURES; k++)
                sum += ((double)a[k] - m->mean[k]) * ((double)b[k] - m->mean[k]);
        }
    }
    return count > 0 && m->variance > 0 ? sum / (double)count / m->variance : 0;
}

/* In texels; infinity where nothing repeats. */
static weft_code period_along(const weft_features *features, int view, bool vertical, double *period, weft_error *error)
{
    const moments m = moments_of(features, view);
    int count = vertical ? features->height : features->width;
    double *along = malloc((size_t)count * sizeof *along);
    if (!along)
        return weft_fail_memory(error, "autocorrelation", (size_t)count * sizeof *along);
#pragma omp parallel for schedule(dynamic)
    for (int lag = 0; lag < count; lag++)
        along[lag] = correlation_at(features, view, &m, vertical ? 0 : lag, vertical ? lag : 0);
    int lag = weft_repeat_first(along, count);
    *period = lag > 0 ? weft_repeat_vertex(along, lag) : (double)INFINITY;
    free(along);
    return WEFT_OK;
}

weft_code weft_relief_period(const weft_features *features, double *period_mm, weft_error *error)
{
    double columns, rows;
    int view = steepest_view(features);
    WEFT_TRY(period_along(features, view, false, &columns, error));
    WEFT_TRY(period_along(features, view, true, &rows, error));
    *period_mm = fmin(columns * features->width_mm / features->width, rows * features->height_mm / features->height);
    return WEFT_OK;
}

/* ---- Reach ---- */

weft_code weft_relief_reach(const weft_features *features, double *reach_mm, weft_error *error)
{
    double side = fmin(features->width_mm, features->height_mm), period;
    double texel = fmax(features->width_mm / features->width, features->height_mm / features->height);
    WEFT_TRY(weft_relief_period(features, &period, error));
    if (features->repeats)
        period = fmin(period, side);
    *reach_mm = isfinite(period) ? stitch_heights * period : fmin(side_share * side, REACH_TEXELS * texel);
    return WEFT_OK;
}
