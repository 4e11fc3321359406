/* A camera of a night: its session, what it has taken so far, and what became of it. */
#ifndef WEFT_CAPTURE_CAMERA_AT_WORK_H
#define WEFT_CAPTURE_CAMERA_AT_WORK_H

#include "capture/photograph_writer.h"
#include "capture/shooting.h"
#include "capture/status/status_page.h"

typedef struct weft_camera_at_work {
    weft_rig *rig;
    weft_session *session;
    int found, taken, damaged;
    weft_shooting shooting;
    weft_photograph_writer *writer; /* NULL: it does not get that far */
    weft_status_page *status;
    int failures;       /* in a row */
    bool left_out;      /* for the rest of the night */
    weft_code code;     /* of its last failure */
    weft_error failure; /* why */
} weft_camera_at_work;

#endif
