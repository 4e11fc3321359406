/* What the photographs of one pose say. */
#ifndef WEFT_CAPTURE_PREFLIGHT_MEASURE_H
#define WEFT_CAPTURE_PREFLIGHT_MEASURE_H

#include "capture/exposure.h"
#include "capture/preflight/preflight.h"
#include "registration/pose/prediction.h"

/* Photographs of a pose, [height][width][3] raw. */
typedef struct weft_preflight_photographs {
    const uint16_t *first, *second, *unlit; /* the same exposure, the last one without the lamp */
    const uint16_t *brief;
    double brief_share; /* exposure of `brief` over that of the others; 1: the camera has no shorter one */
} weft_preflight_photographs;

/* Measures the pose of `shot` and keeps in `check` what is worse than what is there. Errors: WEFT_SYSTEM;
 * WEFT_BAD_INPUT where the camera sees nothing of the sample. */
weft_code weft_preflight_measure(const weft_session *session, const weft_sight *sight, int shot, bool is_frontal,
                                 const weft_preflight_photographs *photographs, weft_preflight_check *check,
                                 weft_error *error);

/* Measures the sensor, in a photograph without light. Errors: WEFT_SYSTEM. */
weft_code weft_preflight_measure_dark(const weft_session *session, weft_angles view, const uint16_t *samples,
                                      weft_preflight_check *check, weft_error *error);

/* Keeps `value` where nothing or something better is known. Pure. */
void weft_preflight_note(weft_preflight_check *check, weft_preflight_kind kind, double value, double limit,
                         weft_angles view);

#endif
