/* The rig: a camera, a stage and a light, each behind a small interface of its own, so that a back end can be written
 * and replaced device by device. Whoever opens a rig hands it to a capture (capture/capture.h), which knows nothing
 * else of it, and closes it afterwards. The virtual rig (capture/virtual/virtual_rig.h) is one back end.
 *
 * Every call blocks until the device has done it. Errors: WEFT_SYSTEM with a message that names the device. No
 * interface is thread-safe: the capture loop calls them from one thread. */
#ifndef WEFT_CAPTURE_RIG_H
#define WEFT_CAPTURE_RIG_H

#include "capture/settings.h"

typedef struct weft_rig_camera {
    void *device;
    /* One photograph: raw samples [height][width][3] of the rig's bits. `frame` numbers the exposures of a session
     * (cameras stamp it into their files). *read_back_s receives the exposure time that the camera reports. */
    weft_code (*expose)(void *device, uint64_t frame, double exposure_s, uint16_t *samples, double *read_back_s,
                        weft_error *error);
} weft_rig_camera;

typedef struct weft_rig_stage {
    void *device;
    /* Drives all axes to their references; called once before the first photograph. The session has seen `first_stay`
     * stays of the camera so far, so that this is the number of the next one. */
    weft_code (*home)(void *device, int first_stay, weft_error *error);
    /* Drives the camera axes. *moved receives whether they turned at all: if so, the photographs that follow belong to
     * a new stay. The first call after home always moves. */
    weft_code (*move_camera)(void *device, weft_angles view, bool *moved, weft_error *error);
    weft_code (*move_light)(void *device, weft_angles light, weft_error *error);
} weft_rig_stage;

typedef struct weft_rig_light {
    void *device;
    weft_code (*power)(void *device, bool on, weft_error *error);
} weft_rig_light;

/* The texts are what session.json remembers of the rig. They belong to the back end. */
typedef struct weft_rig {
    const char *name;     /* of the back end: "virtual" */
    const char *sample;   /* what lies in the opening of the target */
    const char *identity; /* a JSON object with the settings and whatever else the photographs depend on: a session
                             goes on only where all its values are the same */
    weft_rig_settings settings; /* calibration, set-up and exposure */
    weft_rig_camera camera;
    weft_rig_stage stage;
    weft_rig_light light;
} weft_rig;

#endif
