#include "evaluate/error/coverage.h"

#include "base/numeric/statistics.h"

#include <math.h>
#include <stdlib.h>

static const double fifth = 0.2;

static double width_above_zero(double prediction, double half_width)
{
    return fmax(0, prediction + half_width) - fmax(0, prediction - half_width);
}

static void count_one(const weft_covered *one, weft_coverage_share *share)
{
    double prediction = (double)one->value.prediction, half_width = (double)one->half_width;
    share->count++;
    share->covered += fabs((double)one->value.sample - prediction) <= half_width;
    share->width += width_above_zero(prediction, half_width);
}

static void finish(double mean_sample, weft_coverage_share *share)
{
    if (share->count == 0)
        return;
    share->covered /= (double)share->count;
    share->width /= (double)share->count * mean_sample;
}

static void count_all(const weft_covered *covered, size_t count, double dark, double bright, weft_coverage *result)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        const weft_covered *one = &covered[i];
        sum += (double)one->value.sample;
        count_one(one, &result->all);
        count_one(one, &result->by_view[one->view]);
        count_one(one, &result->by_light[one->light]);
        if ((double)one->value.prediction <= dark)
            count_one(one, &result->dark);
        if ((double)one->value.prediction >= bright)
            count_one(one, &result->bright);
    }
    double mean_sample = sum > 0 ? sum / (double)count : 1;
    finish(mean_sample, &result->all);
    finish(mean_sample, &result->dark);
    finish(mean_sample, &result->bright);
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        finish(mean_sample, &result->by_view[ring]);
        finish(mean_sample, &result->by_light[ring]);
    }
}

/* `scratch` is [count]. */
static double find_even_width(const weft_covered *covered, size_t count, double share, float *scratch)
{
    double width = 0, sum = 0;
    for (size_t i = 0; i < count; i++) {
        scratch[i] = fabsf(covered[i].value.sample - covered[i].value.prediction);
        sum += (double)covered[i].value.sample;
    }
    double half_width = (double)weft_quantile_of_floats(scratch, count, share);
    for (size_t i = 0; i < count; i++)
        width += width_above_zero((double)covered[i].value.prediction, half_width);
    return sum > 0 ? width / sum : 0;
}

weft_code weft_coverage_of(const weft_covered *covered, size_t count, weft_coverage *result, weft_error *error)
{
    *result = (weft_coverage){0};
    float *scratch = malloc((count + 1) * sizeof *scratch);
    if (!scratch)
        return weft_fail_memory(error, "samples", count * sizeof *scratch);
    for (size_t i = 0; i < count; i++)
        scratch[i] = covered[i].value.prediction;
    double dark = (double)weft_quantile_of_floats(scratch, count, fifth),
           bright = (double)weft_quantile_of_floats(scratch, count, 1 - fifth);
    count_all(covered, count, dark, bright, result);
    result->even_width = find_even_width(covered, count, result->all.covered, scratch);
    free(scratch);
    return WEFT_OK;
}
