#include "registration/lamp/tone.h"

#include "base/picture/colour.h"

weft_tone_curve weft_tone_srgb(void)
{
    weft_tone_curve tone;
    for (int i = 0; i <= WEFT_TONE_STEPS; i++)
        tone.linear[i] = weft_linear_of_srgb((float)i / WEFT_TONE_STEPS);
    return tone;
}

weft_tone_curve weft_tone_linear(void)
{
    weft_tone_curve tone;
    for (int i = 0; i <= WEFT_TONE_STEPS; i++)
        tone.linear[i] = (float)i / WEFT_TONE_STEPS;
    return tone;
}
