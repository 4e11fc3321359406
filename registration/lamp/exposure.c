#include "registration/lamp/exposure.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* What cameras write: below 100 these numbers and their reciprocals, from there on these of every decade. */
static const double small[] = {1,  1.3, 1.6, 2,  2.5, 3,  3.2, 4,  5,  6,  6.4, 8, 10,
                               13, 15,  16,  20, 25,  30, 32,  40, 50, 60, 64,  80};
static const double large[] = {1, 1.25, 1.6, 2, 2.5, 3.2, 4, 5, 6.4, 8};

static bool holds(const double *list, size_t count, double value)
{
    const double near = 1e-3; /* fractions in a file */
    for (size_t i = 0; i < count; i++) {
        if (fabs(value / list[i] - 1) < near)
            return true;
    }
    return false;
}

static bool is_round(double value)
{
    if (value < 99)
        return holds(small, sizeof small / sizeof *small, value);
    return holds(large, sizeof large / sizeof *large, value / pow(10, floor(log10(value) + 1e-3)));
}

double weft_exposure_meant(double written)
{
    if (!(written > 0) || !(is_round(written) || is_round(1 / written)))
        return written;
    return exp2(round(3 * log2(written)) / 3);
}

/* ISO counts from 100. */
static double sensitivity_meant(double written)
{
    const double first = 100;
    return is_round(written) ? first * exp2(round(3 * log2(written / first)) / 3) : written;
}

double weft_exif_exposure(const weft_exif *exif)
{
    if (!(exif->f_number > 0))
        return 0;
    return weft_exposure_meant(exif->exposure_s) * sensitivity_meant(exif->iso) / (exif->f_number * exif->f_number);
}
