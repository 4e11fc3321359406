/* Linear light and sRGB (IEC 61966-2-1). Pure functions on values in 0..1 (linear may exceed 1). */
#ifndef WEFT_BTF_COLOUR_H
#define WEFT_BTF_COLOUR_H

#include <math.h>

static inline float weft_linear_of_srgb(float encoded)
{
    return encoded <= 0.04045f ? encoded / 12.92f : powf((encoded + 0.055f) / 1.055f, 2.4f);
}

static inline float weft_srgb_of_linear(float linear)
{
    if (!(linear > 0))
        return 0;
    return linear <= 0.0031308f ? linear * 12.92f : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
}

/* Rec. 709 luminance of linear RGB. */
static inline float weft_luminance(const float rgb[3])
{
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

#endif
