/* From light to the numbers of a file: exposure, the sensor's noise, white balance and the tone curve of the camera. */
#ifndef WEFT_CAPTURE_SYNTHETIC_DEVELOP_H
#define WEFT_CAPTURE_SYNTHETIC_DEVELOP_H

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

/* Tone curves of cameras. */
typedef enum weft_synthetic_curve {
    WEFT_SYNTHETIC_CONTRAST, /* t = x^2 / (x + 0.002), then t^n / (t^n + m) over the same at x = 1, n = 0.85, m = 0.4^n:
                           a toe, and a shoulder (the response of Naka and Rushton 1966). Darker than sRGB in the dark
                         */
    WEFT_SYNTHETIC_SOFT      /* ((1 - e^-2x) / (1 - e^-2))^(1/2.2): grains that are hit or not (Poisson), on a screen of
                           gamma 2.2. Brighter than sRGB in the dark */
} weft_synthetic_curve;

typedef struct weft_synthetic_exposure {
    double seconds, f_number, iso; /* as the camera says */
    double gain;                   /* part of the sensor's range that 1 cd/m^2 fills, truly */
    double white_balance[3];       /* multiplies the channels behind the sensor; green is 1 */
} weft_synthetic_exposure;

/* gain = seconds iso / (120 f_number^2): the sensor is full where ISO 12232 has it (78 / iso lux seconds, with 0.65 of
 * the light on the axis). The shutter makes it a little more or less. Pure. */
double weft_synthetic_gain(double seconds, double f_number, double iso);

/* linear [count] 0..1 = what the sensor reads of radiance [count] (count = 3 pixels), black level taken off, white
 * balance applied, clipped: 14 bits, shot and read noise (capture/virtual/sensor.h). `key` alone decides the noise.
 * Parallel. Errors: WEFT_SYSTEM. */
weft_code weft_synthetic_sense(const weft_synthetic_exposure *exposure, const float *radiance, size_t count,
                               uint64_t key, float *linear, weft_error *error);

/* The tone curve of the camera's JPEG, 0..1 to 0..1. Pure. */
double weft_synthetic_tone(weft_synthetic_curve curve, double linear);

#endif
