#include "bench/fit/statistics.h"

#include "base/clock.h"
#include "base/numeric/error_summary.h"

double thread_microseconds(void)
{
    return 1e6 * weft_clock_seconds(CLOCK_THREAD_CPUTIME_ID);
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
    return weft_error_sums_relative_rmse(&(weft_error_sums){.square = energy, .square_error = residual});
}

double share_at_most(const double *values, int count, double limit)
{
    int within = 0;
    for (int i = 0; i < count; i++)
        within += values[i] <= limit;
    return count ? (double)within / count : 0;
}
