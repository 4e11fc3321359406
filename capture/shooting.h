/* One photograph: drive, meter, expose, until the exposure is right. Knows any rig, only through capture/rig.h. */
#ifndef WEFT_CAPTURE_SHOOTING_H
#define WEFT_CAPTURE_SHOOTING_H

#include "capture/exposure.h"
#include "capture/rig.h"

typedef struct weft_shooting {
    weft_rig *rig;
    const weft_session *session;
    weft_exposure_limits limits;
    int retries;
    int stay; /* of the last shot; -1 before the first */
    int next_stay;
    weft_meter meter;  /* of the view */
    double exposure_s; /* of the last shot, 0 before the first */
    weft_real light_cosine;
    int frames;                         /* exposures of this shot so far */
    uint64_t last_frame;                /* number of the last exposure; those behind it are free up to the next shot */
    int exposures, timeouts, disturbed; /* counted; disturbed: the stage did not stand still */
} weft_shooting;

/* Homes the stage; `next_stay` numbers the first stay. Borrows rig and session. The caller ends with weft_shooting_end.
 * Errors: those of the rig; its axes stand still and its light is off then, here and below. */
weft_code weft_shooting_begin(weft_rig *rig, const weft_session *session, int next_stay, weft_shooting *shooting,
                              weft_error *error);
void weft_shooting_end(weft_shooting *shooting);

/* Takes shot `shot` of the session into `samples`; *record receives stay and exposure. A photograph during which the
 * stage did not keep its pose is taken again. Errors: those of the rig, once an exposure or a pose has failed `retries`
 * + 1 times; WEFT_BAD_INPUT where the view shows nothing of the sample. */
weft_code weft_shooting_take(weft_shooting *shooting, int shot, uint16_t *samples, weft_shot_record *record,
                             weft_error *error);

/* Takes the next photograph of a bracket, of the shot that was taken last: shorter where the sensor clipped in the
 * opening, else longer, up to 16 times, until the darkest of the opening reaches a thirty-second of full scale.
 * `samples` holds all photographs of the shot, one after the other: this one goes behind the last. *record gets its
 * exposure. *taken says whether there was need of it. One during which the stage moved is left out, and ends the
 * bracket. Errors: as above. */
weft_code weft_shooting_bracket(weft_shooting *shooting, int shot, uint16_t *samples, weft_shot_record *record,
                                bool *taken, weft_error *error);

#endif
