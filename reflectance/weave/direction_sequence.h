/* Points spread evenly over pairs of directions, for quadrature. Private to the room. */
#ifndef WEFT_REFLECTANCE_WEAVE_DIRECTION_SEQUENCE_H
#define WEFT_REFLECTANCE_WEAVE_DIRECTION_SEQUENCE_H

#include "base/vector.h"

/* Steps of the additive recurrence in `dimensions`: inverse powers of the root of g^(dimensions + 1) = g + 1 (Roberts
 * 2018). */
static inline void recurrence_steps(int dimensions, double *step)
{
    double g = 1, power = 1;
    for (int i = 0; i < 64; i++)
        g = pow(1 + g, 1 / (double)(dimensions + 1));
    for (int i = 0; i < dimensions; i++)
        step[i] = power /= g;
}

/* Coordinate of point k, in [0, 1). */
static inline double recurrence_at(double step, int k)
{
    double x = k * step + 1 / (double)2;
    return x - floor(x);
}

/* A direction above the horizon, with the density cos(theta) / pi; r1, r2 uniform in [0, 1). */
static inline weft_vec3 cosine_weighted(double r1, double r2)
{
    double radius = sqrt(r1), phi = 2 * (double)WEFT_PI * r2;
    return weft_vec3_of((weft_real)(radius * cos(phi)), (weft_real)(radius * sin(phi)), (weft_real)sqrt(1 - r1));
}

#endif
