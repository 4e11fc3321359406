/* The sensor of the virtual camera: photons to raw values. */
#ifndef WEFT_CAPTURE_VIRTUAL_SENSOR_H
#define WEFT_CAPTURE_VIRTUAL_SENSOR_H

#include "capture/virtual/virtual_settings.h"

#include <stddef.h>

/* What is wrong with the pixels of a sensor: [height][width][3], or NULL where nothing is. */
typedef struct weft_virtual_sensor_defects {
    float *response;       /* electrons where a sensor without faults has one */
    float *dark_electrons; /* per second */
    uint8_t *hot;          /* 1: that of each frame is half or one and a half of it, by chance */
} weft_virtual_sensor_defects;

typedef struct weft_virtual_sensor {
    float read_noise;            /* electrons */
    float electrons_per_step;    /* the full well fills the steps above the black level */
    int black_level, full_scale; /* raw values */
    const float *normal;         /* quantiles of the standard normal, WEFT_NORMAL_COUNT of them */
    weft_virtual_sensor_defects faults;
} weft_virtual_sensor;

enum { WEFT_NORMAL_BITS = 12, WEFT_NORMAL_COUNT = 1 << WEFT_NORMAL_BITS };

/* Owned by the caller (weft_virtual_sensor_free), also after a failure. Its faults follow from `seed`; a sensor without
 * any where the settings say so. Errors: WEFT_SYSTEM. */
weft_code weft_virtual_sensor_make(const weft_virtual_settings *settings, uint64_t seed, weft_virtual_sensor *sensor,
                                   weft_error *error);
void weft_virtual_sensor_free(weft_virtual_sensor *sensor);

/* raw = black + (electrons + noise) / electrons_per_step, rounded and clipped, for electrons = response gain radiance +
 * dark_electrons exposure_s (of hot pixels half or one and a half of that, anew in every frame: they blink). The noise
 * is normal with variance electrons + read_noise^2 (shot noise; Poisson to within its skewness above about ten
 * electrons, and read noise hides it below). `key` and the index of a sample alone decide its noise. Parallel. */
void weft_virtual_sensor_read(const weft_virtual_sensor *sensor, const float *radiance, size_t count, double gain,
                              double exposure_s, uint64_t key, uint16_t *samples);

/* ---- What is wrong with the pixels of the virtual sensor. Nothing here is shared with what finds it. ---- */

/* Dark current: that of the usual pixel, with a normal spread, never negative. Hot pixels, by chance, have more:
 * exponentially distributed with their mean. They blink, as random telegraph noise lets them. Response: normal about 1,
 * times what specks of dust let through, whose shadows are soft discs 3 to 9 pixels in radius, alike in all channels.
 * Owned by the caller (weft_virtual_sensor_defects_free), also after a failure. Errors: WEFT_SYSTEM. */
weft_code weft_virtual_sensor_defects_make(const weft_virtual_settings *settings, uint64_t seed,
                                           weft_virtual_sensor_defects *faults, weft_error *error);
void weft_virtual_sensor_defects_free(weft_virtual_sensor_defects *faults);

#endif
