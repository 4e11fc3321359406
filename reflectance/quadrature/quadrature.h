/* Adaptive integration of a function of one variable. Private to the room. */
#ifndef WEFT_REFLECTANCE_QUADRATURE_QUADRATURE_H
#define WEFT_REFLECTANCE_QUADRATURE_QUADRATURE_H

#include "base/vector.h"

/* Where a function is asked for its value. Near an end of the interval the distances are known to full relative
 * precision, x is not. */
typedef struct weft_abscissa {
    weft_real x, from_low, to_high;
} weft_abscissa;

typedef weft_real (*weft_integrand)(const void *context, const weft_abscissa *at);

/* x = middle - half cos(theta) for an interval, 0 <= theta <= pi. */
weft_abscissa weft_abscissa_at(weft_real low, weft_real high, weft_real theta);

/* Integral of `function` over [low, high], low <= high, to about 1e-8 of the integral (double) or to rounding (single).
 * The substitution by theta makes square-root behaviour at either end smooth; kinks and peaks inside are found by
 * bisection (7- and 15-point Gauss-Kronrod rules, Piessens et al. 1983). */
weft_real weft_integrate(weft_integrand function, const void *context, weft_real low, weft_real high);

#endif
