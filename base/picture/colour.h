/* Linear light and sRGB (IEC 61966-2-1). Pure functions on values in 0..1 (linear may exceed 1). */
#ifndef WEFT_BASE_PICTURE_COLOUR_H
#define WEFT_BASE_PICTURE_COLOUR_H

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

/* A signed difference as the eye is to see it everywhere, sRGB: white where there is none, red above, blue below,
 * darkest from -1 and 1 on (RdBu of ColorBrewer, Harrower and Brewer 2003, linear between its steps). White reads as no
 * ink on a page; both hues stay apart for the colour-blind, and a small difference keeps its hue, which near black it
 * would not. What 1 stands for is the picture's to say. GLSL twin: difference_colour in
 * player/draw/shaders/present.frag.glsl. */
static inline void weft_difference_colour(float difference, float srgb[3])
{
    static const float step[2][6][3] = {{{0.969f, 0.969f, 0.969f},
                                         {0.992f, 0.859f, 0.780f},
                                         {0.957f, 0.647f, 0.510f},
                                         {0.839f, 0.376f, 0.302f},
                                         {0.698f, 0.094f, 0.169f},
                                         {0.404f, 0.000f, 0.122f}},
                                        {{0.969f, 0.969f, 0.969f},
                                         {0.820f, 0.898f, 0.941f},
                                         {0.573f, 0.773f, 0.871f},
                                         {0.263f, 0.576f, 0.765f},
                                         {0.129f, 0.400f, 0.675f},
                                         {0.020f, 0.188f, 0.380f}}};
    float size = 5 * fminf(fabsf(difference), 1);
    int lower = size < 4 ? (int)size : 4;
    for (int c = 0; c < 3; c++) {
        float a = step[difference < 0][lower][c], b = step[difference < 0][lower + 1][c];
        srgb[c] = a + (size - (float)lower) * (b - a);
    }
}

/* Mean of the channels: errors are counted over all of them alike, while the luminance of red cloth is next to none. */
static inline float weft_channel_mean(const float rgb[3])
{
    return (rgb[0] + rgb[1] + rgb[2]) / 3;
}

#endif
