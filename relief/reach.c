#include "relief/reach.h"

#include "base/numeric/repeat.h"

#include <math.h>
#include <stdlib.h>

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
