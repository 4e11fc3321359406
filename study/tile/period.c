#include "study/tile/period.h"

#include "study/tile/correlation.h"

#include <math.h>
#include <stdbool.h>

/* A correlation below this is no repeat; noise alone stays far below it, as every lag is a mean over many pairs. */
static const double least_repeat = 0.2;

/* The first peak this close to the highest is the period: the others are its multiples. */
static const double nearly_highest = 0.85;

static bool is_peak(const double *along, int lag)
{
    return along[lag] >= along[lag - 1] && along[lag] > along[lag + 1];
}

/* The vertex of the parabola through a peak and its neighbours. */
static double vertex(const double *along, int lag)
{
    double before = along[lag - 1], after = along[lag + 1], bend = before - 2 * along[lag] + after;
    return bend < 0 ? lag + 0.5 * (before - after) / bend : lag;
}

/* Lag of the first repeat, or 0. Two tiles, or nearly, must fit. */
static int first_repeat(const double *along, int count)
{
    int last = (int)fmin(0.55 * count, count - 2), start = 1;
    double highest = least_repeat;
    while (start < last && along[start + 1] < along[start])
        start++;
    for (int lag = start + 1; lag <= last; lag++)
        highest = is_peak(along, lag) ? fmax(highest, along[lag]) : highest;
    for (int lag = start + 1; lag <= last; lag++)
        if (is_peak(along, lag) && along[lag] >= least_repeat && along[lag] >= nearly_highest * highest)
            return lag;
    return 0;
}

/* The highest peak within a texel and a half of where a multiple should be, or 0. */
static double peak_near(const double *along, int count, double lag)
{
    int best = 0;
    for (int i = (int)ceil(lag - 1.5); i <= (int)floor(lag + 1.5); i++)
        if (i > 0 && i + 1 < count && is_peak(along, i) && (best == 0 || along[i] > along[best]))
            best = i;
    return best > 0 ? vertex(along, best) : 0;
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
    int lag = first_repeat(along, count);
    if (lag == 0)
        return weft_fail(
            error, WEFT_BAD_INPUT,
            "'%s' does not repeat along %s: over its %d texels at least two tiles must fit, each correlated "
            "with the next by more than %g",
            path, axis, count, least_repeat);
    *repeat = along[lag];
    *period = sharpen(along, count, vertex(along, lag));
    return WEFT_OK;
}

weft_code weft_tile_period_find(const weft_tile_pictures *pictures, const char *path, weft_tile_report *report,
                                weft_error *error)
{
    weft_tile_correlation correlation;
    WEFT_TRY(weft_tile_correlate(pictures, &correlation, error));
    weft_tile *tile = &report->tile;
    weft_code code =
        find_axis(correlation.along_x, correlation.columns, "u", path, &tile->width, &report->repeat_x, error);
    if (code == WEFT_OK)
        code = find_axis(correlation.along_y, correlation.rows, "v", path, &tile->height, &report->repeat_y, error);
    weft_tile_correlation_free(&correlation);
    return code;
}
