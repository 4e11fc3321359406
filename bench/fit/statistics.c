#include "bench/fit/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

double thread_microseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e6 * (double)now.tv_sec + 1e-3 * (double)now.tv_nsec;
}

double mean_of(const double *values, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += values[i];
    return count ? sum / count : 0;
}

double relative_rmse(double residual, double energy)
{
    return energy > 0 ? sqrt(residual / energy) : 0;
}

static int compare(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return isnan(a) || isnan(b) ? isnan(a) - isnan(b) : (a > b) - (a < b);
}

double quantile_of(const double *values, int count, double share)
{
    if (!count)
        return 0;
    double *sorted = malloc((size_t)count * sizeof *sorted);
    if (!sorted)
        return NAN;
    memcpy(sorted, values, (size_t)count * sizeof *sorted);
    qsort(sorted, (size_t)count, sizeof *sorted, compare);
    double place = share * (count - 1);
    int below = (int)place, above = below + 1 < count ? below + 1 : below;
    double result = sorted[below] + (place - below) * (sorted[above] - sorted[below]);
    free(sorted);
    return result;
}

double share_at_most(const double *values, int count, double limit)
{
    int within = 0;
    for (int i = 0; i < count; i++)
        within += values[i] <= limit;
    return count ? (double)within / count : 0;
}
