/* The sensor of the virtual camera: photons to raw values. */
#ifndef WEFT_CAPTURE_VIRTUAL_SENSOR_H
#define WEFT_CAPTURE_VIRTUAL_SENSOR_H

#include "capture/virtual/virtual_settings.h"

#include <stddef.h>

typedef struct weft_virtual_sensor {
    float read_noise;            /* electrons */
    float electrons_per_step;    /* the full well fills the steps above the black level */
    int black_level, full_scale; /* raw values */
    const float *normal;         /* quantiles of the standard normal, WEFT_NORMAL_COUNT of them */
} weft_virtual_sensor;

enum { WEFT_NORMAL_BITS = 12, WEFT_NORMAL_COUNT = 1 << WEFT_NORMAL_BITS };

/* Owned by the caller (weft_virtual_sensor_free). Errors: WEFT_SYSTEM. */
weft_code weft_virtual_sensor_make(const weft_virtual_settings *settings, weft_virtual_sensor *sensor,
                                   weft_error *error);
void weft_virtual_sensor_free(weft_virtual_sensor *sensor);

/* raw = black + (electrons + noise) / electrons_per_step, rounded and clipped, for electrons = gain radiance. The noise
 * is normal with variance electrons + read_noise^2 (shot noise; Poisson to within its skewness above about ten
 * electrons, and read noise hides it below). `key` and the index of a sample alone decide its noise. Parallel. */
void weft_virtual_sensor_read(const weft_virtual_sensor *sensor, const float *radiance, size_t count, double gain,
                              uint64_t key, uint16_t *samples);

#endif
