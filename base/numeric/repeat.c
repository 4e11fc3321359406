#include "base/numeric/repeat.h"

#include <math.h>

static const double nearly_highest = 0.85;

double weft_repeat_vertex(const double *along, int lag)
{
    double before = along[lag - 1], after = along[lag + 1], bend = before - 2 * along[lag] + after;
    return bend < 0 ? lag + 0.5 * (before - after) / bend : lag;
}

int weft_repeat_first(const double *along, int count)
{
    int last = (int)fmin(0.55 * count, count - 2), start = 1;
    double highest = WEFT_LEAST_REPEAT;
    while (start < last && along[start + 1] < along[start])
        start++;
    for (int lag = start + 1; lag <= last; lag++)
        highest = weft_repeat_is_peak(along, lag) ? fmax(highest, along[lag]) : highest;
    for (int lag = start + 1; lag <= last; lag++)
        if (weft_repeat_is_peak(along, lag) && along[lag] >= WEFT_LEAST_REPEAT &&
            along[lag] >= nearly_highest * highest)
            return lag;
    return 0;
}
