/* The photographs of a viewpoint: read once, judged, and averaged into one picture of little noise. */
#ifndef WEFT_REGISTRATION_VIEWPOINT_PHOTOGRAPHS_H
#define WEFT_REGISTRATION_VIEWPOINT_PHOTOGRAPHS_H

#include "registration/outcome/outcome.h"
#include "registration/radiometry/sensor_defects.h"

#include <stddef.h>

typedef struct weft_viewpoint_photographs {
    const weft_sensor_defects *faults; /* borrowed */
    int count;
    const int *shot;    /* [count] */
    uint16_t **samples; /* [count] values of faults->seen [height][width][3], NULL where not kept */
    uint8_t *usable;    /* [count] */
    int usable_count;
    float *average; /* [height][width] mean of the channels, linear, vignetting removed, brightness about 1; NaN where
                       every photograph is saturated, or the pixel blind */
} weft_viewpoint_photographs;

/* Reads all photographs of a viewpoint, takes the defects of the sensor out, and averages the usable ones, each
 * weighted by its brightness (that is, by the inverse variance of its shot noise). A photograph that is missing, cut,
 * of another size or black is not usable, and `fault[shot]` says why. Raw values are kept while they fit in
 * `memory_bytes`. The caller frees with weft_viewpoint_photographs_free. Errors: WEFT_SYSTEM. Uses OpenMP; the result
 * does not depend on the number of threads. */
weft_code weft_viewpoint_photographs_read(const weft_sensor_defects *faults, const weft_sight *sight,
                                          const weft_viewpoint *viewpoint, size_t memory_bytes, weft_fault *fault,
                                          weft_viewpoint_photographs *photographs, weft_error *error);
void weft_viewpoint_photographs_free(weft_viewpoint_photographs *photographs);

/* Values of photograph `index`: those kept, or read again into `scratch` (one photograph in size). NULL where the
 * file has gone since. Thread-safe with a scratch for each thread. */
const uint16_t *weft_viewpoint_photographs_samples(const weft_viewpoint_photographs *photographs, int index,
                                                   uint16_t *scratch);

/* Samples in one photograph of a session. */
size_t weft_photograph_sample_count(const weft_session *session);

#endif
