#include "base/numeric/error_summary.h"

#include "base/numeric/statistics.h"

#include <math.h>
#include <stdlib.h>

void weft_error_sums_add(weft_error_sums *sums, const weft_error_sums *other)
{
    sums->count += other->count;
    sums->square += other->square;
    sums->square_error += other->square_error;
}

double weft_error_sums_relative_rmse(const weft_error_sums *sums)
{
    return sums->square > 0 ? sqrt(sums->square_error / sums->square) : 0;
}

static double psnr_of(double peak, double rmse)
{
    if (!(peak > 0))
        return 0;
    return rmse > 0 ? 20 * log10(peak / rmse) : INFINITY;
}

weft_error_summary weft_error_summary_make(const weft_error_sums *sums, double median_relative,
                                           double percentile80_relative, double peak)
{
    double rmse = sums->count > 0 ? sqrt(sums->square_error / sums->count) : 0;
    return (weft_error_summary){.median_relative = median_relative,
                                .percentile80_relative = percentile80_relative,
                                .rmse = rmse,
                                .relative_rmse = weft_error_sums_relative_rmse(sums),
                                .psnr_db = psnr_of(peak, rmse),
                                .count = (long)sums->count};
}

/* The largest dim sample. */
static float dim_limit(const weft_compared *value, size_t count)
{
    float largest = 0;
    for (size_t i = 0; i < count; i++)
        largest = fmaxf(largest, value[i].sample);
    return largest * (float)weft_dim_share;
}

/* `scratch` has room for count values. */
static weft_error_summary summarise(const weft_compared *value, const uint8_t *group, size_t count, int chosen,
                                    float *scratch)
{
    weft_error_sums sums = {0};
    float dim = dim_limit(value, count);
    size_t bright = 0, lit = 0;
    for (size_t i = 0; i < count; i++) {
        if (group && group[i] != chosen)
            continue;
        float sample = value[i].sample, prediction = value[i].prediction;
        weft_error_sums_add_value(&sums, (double)sample, (double)prediction);
        if (sample > dim)
            scratch[bright++] = fabsf(prediction - sample) / sample;
    }
    double median = (double)weft_quantile_of_floats(scratch, bright, 0.5);
    double percentile80 = (double)weft_quantile_of_floats(scratch, bright, 0.8);
    for (size_t i = 0; i < count; i++) {
        if (!(group && group[i] != chosen) && value[i].sample > 0)
            scratch[lit++] = value[i].sample;
    }
    double peak = (double)weft_quantile_of_floats(scratch, lit, weft_peak_share);
    return weft_error_summary_make(&sums, median, percentile80, peak);
}

weft_code weft_error_summary_of_group(const weft_compared *value, const uint8_t *group, size_t count, int chosen,
                                      weft_error_summary *result, weft_error *error)
{
    *result = (weft_error_summary){0};
    float *scratch = malloc((count + 1) * sizeof *scratch);
    if (!scratch)
        return weft_fail_memory(error, "relative errors", count * sizeof *scratch);
    *result = summarise(value, group, count, chosen, scratch);
    free(scratch);
    return WEFT_OK;
}

weft_code weft_error_summary_of(const weft_compared *value, size_t count, weft_error_summary *result, weft_error *error)
{
    return weft_error_summary_of_group(value, NULL, count, 0, result, error);
}
