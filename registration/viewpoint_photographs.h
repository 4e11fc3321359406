/* The photographs of a viewpoint: judged, and averaged into one picture of little noise. */
#ifndef WEFT_REGISTRATION_VIEWPOINT_PHOTOGRAPHS_H
#define WEFT_REGISTRATION_VIEWPOINT_PHOTOGRAPHS_H

#include "registration/outcome/outcome.h"
#include "registration/radiometry/sensor_defects.h"

#include <stddef.h>

typedef struct weft_viewpoint_photographs {
    const weft_sensor_defects *faults; /* borrowed */
    int count;
    const int *shot; /* [count] */
    uint8_t *usable; /* [count] */
    int usable_count;
    float *average; /* [height][width] mean of the channels, linear, vignetting removed, brightness about 1; NaN where
                       every photograph is saturated, or the pixel blind */
} weft_viewpoint_photographs;

/* Reads all photographs of a viewpoint, takes the defects of the sensor out, and averages the usable ones, each
 * weighted by its brightness (that is, by the inverse variance of its shot noise). A photograph that is missing, cut,
 * of another size or black is not usable, and `fault[shot]` says why. The caller frees with
 * weft_viewpoint_photographs_free. Errors: WEFT_SYSTEM. Uses OpenMP; the result does not depend on the number of
 * threads. */
weft_code weft_viewpoint_photographs_read(const weft_sensor_defects *faults, const weft_sight *sight,
                                          const weft_viewpoint *viewpoint, weft_fault *fault,
                                          weft_viewpoint_photographs *photographs, weft_error *error);
void weft_viewpoint_photographs_free(weft_viewpoint_photographs *photographs);

/* Reads the values of photograph `index`, as faults->seen has them, into samples [height][width][3]. False where the
 * file has gone since. Thread-safe. */
bool weft_viewpoint_photographs_samples(const weft_viewpoint_photographs *photographs, int index, uint16_t *samples);

/* Samples in one photograph of a session. */
size_t weft_photograph_sample_count(const weft_session *session);

#endif
