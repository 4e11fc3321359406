#include "player/scene/false_colour.h"

#include "base/picture/colour.h"

const float weft_level_palette[WEFT_LEVEL_COLOURS][3] = {
    {0.9f, 0.9f, 0.9f},  {0.2f, 0.45f, 0.9f},   {0.15f, 0.7f, 0.45f},
    {0.95f, 0.8f, 0.2f}, {0.95f, 0.45f, 0.15f}, {0.75f, 0.1f, 0.25f},
};
/* Magenta and cyan. */
const float weft_extrapolation_tint[2][3] = {{0.7f, 0.03f, 0.45f}, {0, 0.45f, 0.6f}};

void weft_level_shown(const float value[3], float level, float shown[3])
{
    level = fminf(fmaxf(level, 0), WEFT_LEVEL_COLOURS - 1);
    int lower = level < WEFT_LEVEL_COLOURS - 2 ? (int)level : WEFT_LEVEL_COLOURS - 2;
    const float *a = weft_level_palette[lower], *b = weft_level_palette[lower + 1];
    float brightness = 0.25f + 0.75f * weft_channel_mean(value);
    for (int c = 0; c < 3; c++)
        shown[c] = brightness * (a[c] + (level - (float)lower) * (b[c] - a[c]));
}

void weft_extrapolation_shown(const float value[3], bool view, bool light, float shown[3])
{
    float brightness = sqrtf(fmaxf(weft_channel_mean(value), 0));
    for (int c = 0; c < 3; c++) {
        float tint = (float)view * weft_extrapolation_tint[0][c] + (float)light * weft_extrapolation_tint[1][c];
        shown[c] = view || light ? 0.3f * value[c] + (0.1f + 0.9f * brightness) * tint : value[c];
    }
}

/* ---- Swatches ---- */

static const float middle_grey[3] = {0.214f, 0.214f, 0.214f};

static uint32_t swatch_of(const float linear[3])
{
    uint32_t swatch = 0;
    for (int c = 0; c < 3; c++)
        swatch = swatch << 8 | (uint32_t)lrintf(255 * fminf(weft_srgb_of_linear(linear[c]), 1));
    return swatch << 8 | 0xff;
}

uint32_t weft_level_swatch(int level)
{
    float shown[3];
    weft_level_shown(middle_grey, (float)level, shown);
    return swatch_of(shown);
}

uint32_t weft_extrapolation_swatch(bool view, bool light)
{
    float shown[3];
    weft_extrapolation_shown(middle_grey, view, light, shown);
    return swatch_of(shown);
}
