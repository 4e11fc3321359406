/* One photograph: drive, meter, expose, until the exposure is right. Knows any rig, only through capture/rig.h. */
#ifndef WEFT_CAPTURE_SHOOTING_H
#define WEFT_CAPTURE_SHOOTING_H

#include "btf/session/camera_list.h"
#include "capture/exposure.h"
#include "capture/rig.h"

typedef struct weft_shooting {
    weft_rig *rig;
    const weft_session *session;
    weft_exposure_limits limits;
    int retries;
    int viewpoint; /* of the last shot; -1 before the first */
    int next_viewpoint;
    weft_meter meter;  /* of the view */
    double exposure_s; /* of the last shot, 0 before the first */
    weft_real light_cosine;
    int frames;                         /* exposures of this shot so far */
    uint64_t last_frame;                /* number of the last exposure; those behind it are free up to the next shot */
    int exposures, timeouts, disturbed; /* counted; disturbed: the stage did not stand still */
} weft_shooting;

/* Homes the stage; `next_viewpoint` numbers the first viewpoint. Borrows rig and session. The caller ends with
 * weft_shooting_end. Errors: those of the rig; its axes stand still and its light is off then, here and below. */
weft_code weft_shooting_begin(weft_rig *rig, const weft_session *session, int next_viewpoint, weft_shooting *shooting,
                              weft_error *error);
void weft_shooting_end(weft_shooting *shooting);

/* Takes shot `shot` of the session into `samples`; *record receives viewpoint and exposure. A photograph during which
 * the stage did not keep its pose is taken again. Errors: those of the rig, once an exposure or a pose has failed
 * `retries`
 * + 1 times; WEFT_BAD_INPUT where the view shows nothing of the sample. */
weft_code weft_shooting_take(weft_shooting *shooting, int shot, uint16_t *samples, weft_shot_record *record,
                             weft_error *error);

/* ---- What a volley is made of (capture/volley.h) ---- */

/* Takes up the pose of a shot; the meter is that of its view. Errors: those of the stage; WEFT_BAD_INPUT as above. */
weft_code weft_shooting_drive(weft_shooting *shooting, int shot, weft_error *error);

/* Exposes under the light that burns, until the exposure is right. Errors: those of the camera. */
weft_code weft_shooting_meter_and_expose(weft_shooting *shooting, int shot, uint16_t *samples, double *read_back_s,
                                         weft_error *error);

/* One exposure, repeated where the camera does not deliver it. Errors: those of the camera. */
weft_code weft_shooting_expose(weft_shooting *shooting, int shot, double exposure_s, uint16_t *samples,
                               double *read_back_s, weft_error *error);

/* Returns `code`. Whatever has failed, nothing moves on and nothing burns on. */
weft_code weft_shooting_halt(weft_shooting *shooting, weft_code code);

#endif
