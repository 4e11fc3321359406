#include "registration/colour/difference.h"

#include "base/numeric/cholesky.h"
#include "base/picture/colour_space.h"

#include <lcms2.h>
#include <math.h>

static const double xyz_of_rgb[3][3] = {
    {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};

void weft_lab_of_linear_srgb(const double rgb[3], double lab[3])
{
    const cmsCIEXYZ white = {weft_d65[0], weft_d65[1], weft_d65[2]};
    double xyz[3];
    cmsCIELab found;
    for (int i = 0; i < 3; i++)
        xyz[i] = xyz_of_rgb[i][0] * rgb[0] + xyz_of_rgb[i][1] * rgb[1] + xyz_of_rgb[i][2] * rgb[2];
    cmsXYZ2Lab(&white, &found, &(cmsCIEXYZ){xyz[0], xyz[1], xyz[2]});
    lab[0] = found.L, lab[1] = found.a, lab[2] = found.b;
}

void weft_linear_srgb_of_lab_d50(const double lab[3], double rgb[3])
{
    const cmsCIEXYZ white = {weft_d50[0], weft_d50[1], weft_d50[2]};
    cmsCIEXYZ found;
    cmsLab2XYZ(&white, &found, &(cmsCIELab){lab[0], lab[1], lab[2]});
    weft_linear_srgb_of_xyz((const double[3]){found.X, found.Y, found.Z}, weft_d50, rgb);
}

double weft_ciede2000(const double lab[3], const double other[3])
{
    return cmsCIE2000DeltaE(&(cmsCIELab){lab[0], lab[1], lab[2]}, &(cmsCIELab){other[0], other[1], other[2]}, 1, 1, 1);
}

/* Squared CIEDE2000 between the colours that lie `step` below and above a colour. */
static double squared_across(const double rgb[3], const double step[3])
{
    double below[3], above[3], low[3], high[3];
    for (int i = 0; i < 3; i++) {
        below[i] = rgb[i] - step[i];
        above[i] = rgb[i] + step[i];
    }
    weft_lab_of_linear_srgb(below, low);
    weft_lab_of_linear_srgb(above, high);
    double difference = weft_ciede2000(low, high);
    return difference * difference;
}

/* The squared difference is d' M d; the metric is the transpose of the Cholesky factor of M. */
void weft_ciede2000_metric(const double rgb[3], double metric[3][3])
{
    double size[3], m[3][3] = {{0}};
    for (int i = 0; i < 3; i++)
        size[i] = 1e-4 * (fabs(rgb[i]) + 0.01);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k <= i; k++) {
            double same[3] = {0}, opposite[3] = {0};
            same[i] = opposite[i] = size[i] / 2;
            same[k] += size[k] / 2;
            opposite[k] -= size[k] / 2;
            m[i][k] = (squared_across(rgb, same) - squared_across(rgb, opposite)) / (4 * size[i] * size[k]);
        }
    }
    weft_cholesky_factor(3, 3, m[0]);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            metric[i][k] = k >= i ? m[k][i] : 0;
}
