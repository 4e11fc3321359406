/* Adaptive integration of a function of one variable. Private to the room. */
#ifndef WEFT_REFLECTANCE_QUADRATURE_H
#define WEFT_REFLECTANCE_QUADRATURE_H

#include "btf/vector.h"

typedef weft_real (*integrand_function)(const void *context, weft_real x);

/* Integral of `function` over [low, high], low <= high, to about 1e-8 of the integral (double) or to rounding (single).
 * The substitution x = middle - half cos(theta) makes square-root behaviour at either end smooth; kinks and steps
 * inside are found by bisection (7- and 15-point Gauss-Kronrod rules, Piessens et al. 1983). */
weft_real integrate(integrand_function function, const void *context, weft_real low, weft_real high);

#endif
