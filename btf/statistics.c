#include "btf/statistics.h"

#include <math.h>
#include <stdlib.h>

static int order_of(double a, double b)
{
    return isnan(a) || isnan(b) ? isnan(a) - isnan(b) : (a > b) - (a < b);
}

static int compare_doubles(const void *left, const void *right)
{
    return order_of(*(const double *)left, *(const double *)right);
}

static int compare_floats(const void *left, const void *right)
{
    return order_of((double)*(const float *)left, (double)*(const float *)right);
}

size_t weft_quantile_rank(size_t count, double share)
{
    return (size_t)llround(share * (double)(count - 1));
}

double weft_quantile(double *value, size_t count, double share)
{
    if (count == 0)
        return 0;
    qsort(value, count, sizeof *value, compare_doubles);
    return value[weft_quantile_rank(count, share)];
}

float weft_quantile_of_floats(float *value, size_t count, double share)
{
    if (count == 0)
        return 0;
    qsort(value, count, sizeof *value, compare_floats);
    return value[weft_quantile_rank(count, share)];
}
