#include "registration/lamp/tone.h"

#include "base/picture/colour.h"

#include <math.h>

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

double weft_tone_bend(weft_tone_curve *tone, const double *term, int terms)
{
    double last = 0;
    for (int i = 0; i <= WEFT_TONE_STEPS; i++) {
        double power = 1, sum = 0, encoded = 2 * (i / (double)WEFT_TONE_STEPS) - 1;
        for (int k = 0; k < terms; k++)
            sum += term[k] * (power *= encoded);
        double light = (double)tone->linear[i] * exp(sum);
        last = i ? fmax(last, light) : light;
        tone->linear[i] = (float)last;
    }
    for (int i = 0; i <= WEFT_TONE_STEPS; i++)
        tone->linear[i] /= (float)last;
    return last;
}
