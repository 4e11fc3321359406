#include "player/scene/false_colour.h"

#include "base/picture/colour.h"

const float weft_level_palette[WEFT_LEVEL_COLOURS][3] = {
    {0.9f, 0.9f, 0.9f},  {0.2f, 0.45f, 0.9f},   {0.15f, 0.7f, 0.45f},
    {0.95f, 0.8f, 0.2f}, {0.95f, 0.45f, 0.15f}, {0.75f, 0.1f, 0.25f},
};
/* Magenta, cyan and amber. */
const float weft_extrapolation_tint[WEFT_EXTRAPOLATION_TINTS][3] = {
    {0.7f, 0.03f, 0.45f}, {0, 0.45f, 0.6f}, {0.75f, 0.4f, 0}};

void weft_level_shown(const float value[3], float level, float shown[3])
{
    level = fminf(fmaxf(level, 0), WEFT_LEVEL_COLOURS - 1);
    int lower = level < WEFT_LEVEL_COLOURS - 2 ? (int)level : WEFT_LEVEL_COLOURS - 2;
    const float *a = weft_level_palette[lower], *b = weft_level_palette[lower + 1];
    float brightness = 0.25f + 0.75f * weft_channel_mean(value);
    for (int c = 0; c < 3; c++)
        shown[c] = brightness * (a[c] + (level - (float)lower) * (b[c] - a[c]));
}

void weft_extrapolation_shown(const float value[3], weft_missing missing, float shown[3])
{
    const float share[WEFT_EXTRAPOLATION_TINTS] = {(float)missing.view, (float)missing.light, (float)missing.place};
    bool any = missing.view || missing.light || missing.place;
    float brightness = sqrtf(fmaxf(weft_channel_mean(value), 0));
    for (int c = 0; c < 3; c++) {
        float tint = 0;
        for (int i = 0; i < WEFT_EXTRAPOLATION_TINTS; i++)
            tint += share[i] * weft_extrapolation_tint[i][c];
        shown[c] = any ? 0.3f * value[c] + (0.1f + 0.9f * brightness) * tint : value[c];
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

uint32_t weft_extrapolation_swatch(weft_missing missing)
{
    float shown[3];
    weft_extrapolation_shown(middle_grey, missing, shown);
    return swatch_of(shown);
}
