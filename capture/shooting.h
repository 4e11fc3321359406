/* One photograph: drive, meter, expose, until the exposure is right. Knows any rig, only through capture/rig.h. */
#ifndef WEFT_CAPTURE_SHOOTING_H
#define WEFT_CAPTURE_SHOOTING_H

#include "base/progress.h"
#include "btf/session/camera_list.h"
#include "capture/exposure.h"
#include "capture/rig.h"

#include <signal.h>

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

/* ---- Synchronised shots: all cameras that see one light in one pose of the stage, exposed together ---- */

/* One camera of a synchronised shot. `samples` holds all photographs of the shot, one after the other. */
typedef struct weft_exposing {
    weft_shooting *shooting;
    int shot;
    uint16_t *samples;
    weft_shot_record record; /* viewpoint, exposure, brackets */
    weft_code code;          /* of this camera alone; what follows is for synchronised shots */
    weft_error error;        /* why */
    double exposure_s, read_back_s;
    bool wanted; /* whether it exposes now */
} weft_exposing;

/* Takes the first photograph of each: drives the stage, switches the lamp on once, and lets each camera meter and
 * expose, each in a thread of its own where there are several. A shot during which the stage did not keep its pose is
 * taken again. A camera that fails has its own `code`, and the others have their photographs. Errors: those of stage
 * and light. Then, and where all cameras fail, axes stand still and the light is off. */
weft_code weft_shot_take(weft_exposing *exposing, int count, weft_error *error);

/* Fails: the stage moved during a photograph, `times` times. Its axes stand still then. */
weft_code weft_shot_fail_disturbed(const weft_exposing *exposing, int times, weft_error *error);

/* Takes the next photograph of the bracket of each that needs one and did not fail: shorter where the sensor clipped in
 * the opening, else longer, up to 16 times, until the darkest of the opening reaches a thirty-second of full scale. It
 * goes behind the last one in `samples`; record gets its exposure. *taken says how many there were, and `wanted` whose.
 * *held says whether the stage kept its pose: where it did not, the shot is to be taken again from its beginning, for
 * its photographs share one pose. Errors: as above. */
weft_code weft_shot_bracket(weft_exposing *exposing, int count, int most, int *taken, bool *held, weft_error *error);

/* ---- Frames of the sensor, taken before the first shot: without light, and of an even field. Registration finds the faults
 * of the sensor in them (registration/radiometry/sensor_defects.h). */

/* Frames of the session that are not taken yet. Pure. */
int weft_sensor_frames_missing(const weft_session *session);

/* Takes them, and writes each to the disk and to the journal. Dark ones are exposed as briefly and as long as the rig
 * exposes: what lies between follows from the two. The flat ones are exposed so that the 99.5th percentile of the
 * brightest channel lies just below 0.8 of full scale. Returns between frames where `stop` (may be NULL) is not 0. In
 * the end, also after a failure, the camera sees the sample again, and the lamp is off. Errors: those of the rig, once
 * an exposure has failed `retries` + 1 times; WEFT_SYSTEM. */
weft_code weft_sensor_frames_take(weft_rig *rig, weft_session *session, const volatile sig_atomic_t *stop,
                                  const weft_progress *progress, weft_error *error);

#endif
