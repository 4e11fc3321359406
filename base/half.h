/* IEEE 754 binary16 ("half float"), the storage type of samples and lobes. Rounds to nearest
 * even; values beyond 65504 become infinity, NaN stays NaN; below 2^-14 (6.1e-5) they are whole multiples of 2^-24
 * (6.0e-8). The same with denormals on and off. Pure functions. */
#ifndef WEFT_BASE_HALF_H
#define WEFT_BASE_HALF_H

#include "base/real.h"

#include <string.h>

static inline float weft_float_of_half(weft_half half)
{
    /* A subnormal half counts steps of 2^-24. It must not pass through a subnormal float, which a thread that takes
     * denormals for 0 (base/processor.h) would lose. */
    uint32_t magnitude = half & 0x7fff, bits;
    float steps = (float)(int32_t)magnitude * 0x1p-24f, value;
    memcpy(&bits, &steps, sizeof bits);
    if (magnitude >= 0x0400)
        bits = (magnitude << 13) + (magnitude >= 0x7c00 ? 0x70000000u : 0x38000000u);
    bits |= (uint32_t)(half & 0x8000) << 16;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline weft_half weft_half_of_float(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    uint32_t sign = bits >> 16 & 0x8000;
    uint32_t magnitude = bits & 0x7fffffff;
    if (magnitude > 0x7f800000)
        return (weft_half)(sign | 0x7e00);
    if (magnitude >= 0x477ff000)
        return (weft_half)(sign | 0x7c00);
    if (magnitude < 0x38800000) {
        /* Subnormal half: adding 0.5 lets the float adder round the mantissa to 2^-24. A subnormal float is 0 here,
         * taken for it or not. */
        float shifted;
        memcpy(&shifted, &magnitude, sizeof shifted);
        shifted += 0.5f;
        memcpy(&magnitude, &shifted, sizeof magnitude);
        return (weft_half)(sign | (magnitude - 0x3f000000));
    }
    uint32_t odd = magnitude >> 13 & 1;
    magnitude += 0xc8000fff + odd;
    return (weft_half)(sign | magnitude >> 13);
}

#endif
