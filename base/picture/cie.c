#include "base/picture/cie.h"

const double weft_d50[3] = {0.9642, 1, 0.8249}, weft_d65[3] = {0.95047, 1, 1.08883};

static const double rgb_of_xyz[3][3] = {
    {3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}};

/* Bradford's cone responses of XYZ, and back. */
static const double cones_of_xyz[3][3] = {
    {0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}};
static const double xyz_of_cones[3][3] = {
    {0.9869929, -0.1470543, 0.1599627}, {0.4323053, 0.5183603, 0.0492912}, {-0.0085287, 0.0400428, 0.9684867}};

static void multiply(const double m[3][3], const double v[3], double product[3])
{
    for (int i = 0; i < 3; i++)
        product[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
}

void weft_linear_srgb_of_xyz(const double xyz[3], const double white[3], double rgb[3])
{
    double cones[3], from[3], to[3], adapted[3];
    multiply(cones_of_xyz, xyz, cones);
    multiply(cones_of_xyz, white, from);
    multiply(cones_of_xyz, weft_d65, to);
    for (int i = 0; i < 3; i++)
        cones[i] *= to[i] / from[i];
    multiply(xyz_of_cones, cones, adapted);
    multiply(rgb_of_xyz, adapted, rgb);
}
