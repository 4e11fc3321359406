#include "base/numeric/statistics.h"

#include <algorithm>
#include <cmath>

namespace
{

template <typename number> bool is_below(number a, number b)
{
    return std::isnan(b) ? !std::isnan(a) : a < b;
}

template <typename number> number quantile(number *value, size_t count, double share)
{
    if (count == 0)
        return 0;
    number *found = value + std::llround(share * static_cast<double>(count - 1));
    std::nth_element(value, found, value + count, is_below<number>);
    return *found;
}

} // namespace

double weft_quantile(double *value, size_t count, double share)
{
    return quantile(value, count, share);
}

float weft_quantile_of_floats(float *value, size_t count, double share)
{
    return quantile(value, count, share);
}
