/* A night: all volleys of a session, taken and written. */
#ifndef WEFT_CAPTURE_NIGHT_H
#define WEFT_CAPTURE_NIGHT_H

#include "capture/capture.h"
#include "capture/volley_order.h"

/* All borrowed. */
typedef struct weft_night {
    weft_rig *rig; /* of the first camera */
    int camera_count;
    weft_held_session *held; /* [camera_count] */
    int brackets;
    const char *status; /* folder of the status page, with one of each of several cameras in it; NULL: none */
    const weft_volley_order *order;
    weft_capture_summary *summary;
    const volatile sig_atomic_t *stop;
    const weft_progress *progress;
} weft_night;

/* Takes the frames of each sensor, then the volleys, and counts in night->summary. Returns between volleys where `stop`
 * is not 0. Errors: those of weft_capture_take, but for the stop. */
weft_code weft_night_take(const weft_night *night, weft_error *error);

#endif
