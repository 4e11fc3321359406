/* The pixels of a photograph, in proportion to light. */
#ifndef WEFT_REGISTRATION_LAMP_READ_H
#define WEFT_REGISTRATION_LAMP_READ_H

#include "base/picture/exif.h"
#include "base/status.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- The tone curve of a camera: from encoded values to values in proportion to light ---- */

enum { WEFT_TONE_STEPS = 1024 };

/* linear[i] is the light of the encoded value i / WEFT_TONE_STEPS. It grows with i, and the last is 1. */
typedef struct weft_tone_curve {
    float linear[WEFT_TONE_STEPS + 1];
} weft_tone_curve;

/* What a file that says nothing else is taken for: sRGB (IEC 61966-2-1), or values that are linear already. */
weft_tone_curve weft_tone_srgb(void);
weft_tone_curve weft_tone_linear(void);

/* Corrections of the logarithm of light: coefficients of cubic B-splines that are evenly spaced over encoded values. */
enum { WEFT_TONE_TERMS = 16 };

/* What every coefficient counts for at an encoded value within 0..1, and how that changes with it. Pure. */
void weft_tone_basis(double encoded, double value[WEFT_TONE_TERMS], double slope[WEFT_TONE_TERMS]);

/* Multiplies the light of every encoded value by the exponential of its correction, lets it never fall, and divides it
 * by what it has at 1, which is returned. Pure. */
double weft_tone_bend(weft_tone_curve *tone, const double term[WEFT_TONE_TERMS]);

/* Light of an encoded value, which is held to 0..1: linear between the steps. Pure. */
static inline float weft_tone_decode(const weft_tone_curve *tone, float encoded)
{
    float place = encoded > 0 ? (encoded < 1 ? encoded : 1) * WEFT_TONE_STEPS : 0;
    int step = place < WEFT_TONE_STEPS ? (int)place : WEFT_TONE_STEPS - 1;
    return tone->linear[step] + (place - (float)step) * (tone->linear[step + 1] - tone->linear[step]);
}

/* A sample that has reached this is clipped. */
enum { WEFT_PHOTOGRAPHS_FULL_SCALE = 65535 };

/* What a file's values are good for, 0..1 of its range. */
typedef struct weft_file_range {
    float clipped_at; /* one that has reached it is clipped */
    float dark_at; /* light below that of it is too dark to be read: five steps of the file, so that one step is a fifth
                      of the value. The samples here have 65535 steps, so floats count as 16 bits */
} weft_file_range;

weft_file_range weft_file_range_of(const weft_exif *exif, double clipped_at);

typedef struct weft_light_values {
    int width, height;
    uint16_t *samples; /* [height][width][3] light, WEFT_PHOTOGRAPHS_FULL_SCALE where the file's value is clipped */
    float *grey;       /* [height][width] mean of the channels, 1 at full scale; NaN where one is clipped */
    float dark;        /* light below it is too dark to be read; 1 at full scale */
} weft_light_values;

/* Reads an image file of width x height pixels. Its values are decoded by `tone`. The caller frees with
 * weft_light_values_free. Errors: WEFT_BAD_INPUT naming the file; WEFT_SYSTEM for memory. Thread-safe. */
weft_code weft_light_values_read(const char *path, int width, int height, const weft_tone_curve *tone,
                                 weft_file_range range, weft_light_values *values, weft_error *error);
void weft_light_values_free(weft_light_values *values);

/* ---- The exposure that a camera means ---- */

/* Cameras count in thirds of a stop and write round numbers: 1/60 s is 1/64 s. Returns 2^(k/3) for such a number of
 * seconds, and every other one as it is: telephones write what they mean. Pure. */
double weft_exposure_meant(double written);

/* Time x sensitivity / f-number^2: time as meant; ISO 125 is 126; the f-number as written. 0 where the camera wrote
 * none. Pure. */
double weft_exif_exposure(const weft_exif *exif);

#ifdef __cplusplus
}
#endif

#endif
