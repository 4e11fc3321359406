#include "study/error/prediction_error.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static const double floor_share = 1e-4;

static bool is_chosen(const weft_prediction *value, weft_prediction_choice choice)
{
    switch (choice.by) {
    case WEFT_CHOOSE_VIEW_RING:
        return value->view_ring == choice.ring;
    case WEFT_CHOOSE_LIGHT_RING:
        return value->light_ring == choice.ring;
    default:
        return true;
    }
}

static double floor_of(const weft_prediction *value, long count)
{
    double largest = 0;
    for (long i = 0; i < count; i++)
        largest = fmax(largest, (double)value[i].sample);
    return largest > 0 ? floor_share * largest : 1;
}

static int ascending(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Of sorted values. */
static double median(const float *value, long count)
{
    if (count == 0)
        return 0;
    double middle = (double)value[count / 2];
    return count % 2 ? middle : 0.5 * (middle + (double)value[count / 2 - 1]);
}

/* The smallest of sorted values that four fifths of them do not exceed. */
static double percentile80(const float *value, long count)
{
    return count == 0 ? 0 : (double)value[(4 * count + 4) / 5 - 1];
}

weft_code weft_prediction_error_of(const weft_prediction *value, long count, weft_prediction_choice choice,
                                   weft_prediction_error *result, weft_error *error)
{
    *result = (weft_prediction_error){0};
    float *relative = malloc(((size_t)count + 1) * sizeof *relative);
    if (!relative)
        return weft_fail_memory(error, "relative errors", (unsigned long long)count * sizeof *relative);
    double floor_value = floor_of(value, count), squared_error = 0, squared_sample = 0;
    for (long i = 0; i < count; i++) {
        if (!is_chosen(&value[i], choice))
            continue;
        double sample = (double)value[i].sample, difference = (double)value[i].prediction - sample;
        squared_error += difference * difference;
        squared_sample += sample * sample;
        relative[result->count++] = (float)(fabs(difference) / fmax(sample, floor_value));
    }
    if (result->count > 0)
        result->rmse = sqrt(squared_error / (double)result->count);
    if (squared_sample > 0)
        result->relative_rmse = sqrt(squared_error / squared_sample);
    qsort(relative, (size_t)result->count, sizeof *relative, ascending);
    result->median_relative = median(relative, result->count);
    result->percentile80_relative = percentile80(relative, result->count);
    free(relative);
    return WEFT_OK;
}
