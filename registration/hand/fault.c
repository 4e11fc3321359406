#include "registration/hand/fault.h"

#include <math.h>

enum { longer_lag = 8 };

static const double darkest_mean = 0.004, clipped_share = 0.5;

/* Of sharp edges the sharpness is 1, of edges as wide as the longer lag and wider 1 / longer_lag. */
static const double least_sharpness = 0.3;

/* Mean squared difference of the square root of light at a lag, which evens out its noise. */
static double difference(const weft_light_values *values, int dx, int dy)
{
    double sum = 0;
    long count = 0;
    int reach = longer_lag;
    for (int y = reach; y < values->height - reach; y += 2) {
        for (int x = reach; x < values->width - reach; x++) {
            float a = values->grey[(long)y * values->width + x],
                  b = values->grey[(long)(y + dy) * values->width + x + dx];
            if (!isfinite(a) || !isfinite(b))
                continue;
            double step = sqrt((double)b) - sqrt((double)a);
            sum += step * step;
            count++;
        }
    }
    return count > 0 ? sum / (double)count : 0;
}

static double sharpness(const weft_light_values *values)
{
    static const int direction[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    double least = INFINITY;
    for (int i = 0; i < 4; i++) {
        int dx = direction[i][0], dy = direction[i][1];
        double far = difference(values, longer_lag * dx, longer_lag * dy);
        least = fmin(least, far > 0 ? longer_lag * difference(values, dx, dy) / far : 0);
    }
    return least;
}

const char *weft_photograph_fault(const weft_light_values *values)
{
    double sum = 0, clipped = 0, pixels = (double)values->width * values->height;
    for (long i = 0; i < (long)values->width * values->height; i++) {
        if (isfinite(values->grey[i]))
            sum += (double)values->grey[i];
        else
            clipped++;
    }
    if (clipped > clipped_share * pixels)
        return "it is overexposed";
    if (sum < darkest_mean * pixels)
        return "it is dark (was the lens covered?)";
    if (sharpness(values) < least_sharpness)
        return "it is blurred";
    return "it shows something else, or too little of the sheet";
}
