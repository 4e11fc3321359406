/* The tone curve of a camera: from the encoded values of a file to values in proportion to light. */
#ifndef WEFT_REGISTRATION_LAMP_TONE_H
#define WEFT_REGISTRATION_LAMP_TONE_H

enum { WEFT_TONE_STEPS = 1024 };

/* linear[i] is the light of the encoded value i / WEFT_TONE_STEPS. It grows with i, and the last is 1. */
typedef struct weft_tone_curve {
    float linear[WEFT_TONE_STEPS + 1];
} weft_tone_curve;

/* What a file that says nothing else is taken for: sRGB (IEC 61966-2-1), or values that are linear already. */
weft_tone_curve weft_tone_srgb(void);
weft_tone_curve weft_tone_linear(void);

/* Multiplies the light of an encoded value v by exp(sum_k term[k] (2 v - 1)^(k + 1)), lets it never fall, and divides
 * it by what it has at 1, which is returned. Pure. */
double weft_tone_bend(weft_tone_curve *tone, const double *term, int terms);

/* Light of an encoded value, which is held to 0..1: linear between the steps. Pure. */
static inline float weft_tone_decode(const weft_tone_curve *tone, float encoded)
{
    float place = encoded > 0 ? (encoded < 1 ? encoded : 1) * WEFT_TONE_STEPS : 0;
    int step = place < WEFT_TONE_STEPS ? (int)place : WEFT_TONE_STEPS - 1;
    return tone->linear[step] + (place - (float)step) * (tone->linear[step + 1] - tone->linear[step]);
}

#endif
