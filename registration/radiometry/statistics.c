#include "registration/radiometry/statistics.h"

#include <math.h>
#include <stdlib.h>

static int compare_doubles(const void *first, const void *second)
{
    double a = *(const double *)first, b = *(const double *)second;
    return a < b ? -1 : a > b;
}

double weft_quantile(double *value, int count, double quantile)
{
    if (count < 1)
        return 0;
    qsort(value, (size_t)count, sizeof *value, compare_doubles);
    return value[(int)lround(quantile * (count - 1))];
}
