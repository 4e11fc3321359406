/* The rig: a camera, a stage and a light, each behind a small interface of its own, so that a back end can be written
 * and replaced device by device. Whoever opens a rig hands it to a capture (capture/capture.h), which knows nothing
 * else of it, and closes it afterwards. The virtual rig (capture/virtual/virtual_rig.h) is one back end.
 *
 * A rig with several cameras is several weft_rig that share stage and light: each is its camera, with the stage as that
 * camera stands on it. A capture drives them together.
 *
 * Every call blocks until the device has done it. Errors: WEFT_SYSTEM with a message that names the device. No
 * interface is thread-safe: the capture loop calls them from one thread. But it lets each of several cameras expose in
 * a thread of its own, at the same time. */
#ifndef WEFT_CAPTURE_RIG_H
#define WEFT_CAPTURE_RIG_H

#include "btf/session/session.h"
#include "capture/settings.h"

typedef struct weft_rig_camera {
    void *device;
    /* One photograph: raw samples [height][width][3] of the rig's bits. `frame` numbers the exposures of a session
     * (cameras stamp it into their files). *read_back_s receives the exposure time that the camera reports. */
    weft_code (*expose)(void *device, uint64_t frame, double exposure_s, uint16_t *samples, double *read_back_s,
                        weft_error *error);
    /* The file that the last exposure came as, for the session to keep; NULL: there is none. */
    const char *(*original)(void *device);
    void (*close)(void *device); /* NULL: whoever opened the rig does more than that */
} weft_rig_camera;

/* What it takes a stage to go through poses, from the first to the last. */
typedef struct weft_stage_estimate {
    double seconds; /* of moving and settling */
    int moves;      /* of any axis */
} weft_stage_estimate;

/* Where axes and lamps stand for a photograph, in numbers that only their stage understands. */
enum { WEFT_PLACE_NUMBERS = 10 };
typedef struct weft_place {
    double at[WEFT_PLACE_NUMBERS]; /* equal within 1e-6: the same place */
} weft_place;

/* Functions that may be NULL say what is then understood. */
typedef struct weft_rig_stage {
    void *device;
    /* Drives all axes to their references; called once before the first photograph. The session has seen
     * `first_viewpoint` viewpoints of the camera so far, so that this is the number of the next one. */
    weft_code (*home)(void *device, int first_viewpoint, weft_error *error);
    /* Takes up the pose of a photograph. *moved receives whether the camera turned against the sample, or may have: if
     * so, the photographs that follow belong to a new viewpoint. The first call after home always moves. */
    weft_code (*move)(void *device, weft_angles view, weft_angles light, bool *moved, weft_error *error);
    /* Whether the axes stand where the last move left them, and have stood there since; NULL: nothing disturbs them. */
    weft_code (*held)(void *device, bool *held, weft_error *error);
    /* Stops every axis where it is, whatever has gone wrong before; NULL: nothing moves between the calls. */
    void (*stop)(void *device);
    /* Whether the stage can take up the pose of a shot; may send the light to where one of its lamps is. Pure. NULL: it
     * can take up any. Errors: WEFT_BAD_INPUT naming the axis that cannot. */
    weft_code (*reach)(void *device, weft_shot *shot, weft_error *error);
    /* Where the axes of camera and sample stand for a shot that it can take up. Pure. NULL: it has none that are known.
     * Errors: those of reach. */
    weft_code (*turns)(void *device, const weft_shot *shot, weft_turns *turns, weft_error *error);
    /* Sorts `count` numbers of shots so that the stage is through with them soon. Moves nothing. NULL: they are taken
     * in the order of the plan, and nothing is known of the time. Errors: WEFT_SYSTEM. */
    weft_code (*order)(void *device, const weft_shot *shot, int count, int *numbers, weft_stage_estimate *estimate,
                       weft_error *error);
    /* Of a rig with several cameras: where its axes and lamps stand for a shot of this camera, which is the same place
     * as for a shot of another one where both can be taken at once. Pure. Errors: those of reach. */
    weft_code (*place)(void *device, const weft_shot *shot, weft_place *place, weft_error *error);
    /* Of a rig with several cameras: from where this one sees the sample while `taker`, the stage of another, has taken
     * up a shot. Pure. Errors: those of reach. */
    weft_code (*view_of)(void *device, void *taker, const weft_shot *shot, weft_angles *view, weft_error *error);
} weft_rig_stage;

typedef struct weft_rig_light {
    void *device;
    weft_code (*power)(void *device, bool on, weft_error *error);
} weft_rig_light;

/* What the camera is to see. */
typedef enum weft_curtain {
    WEFT_CURTAIN_OPEN, /* the plate, as on any other day */
    WEFT_CURTAIN_DARK, /* nothing: no light reaches it */
    WEFT_CURTAIN_EVEN  /* a field of even brightness, all over the photograph */
} weft_curtain;

/* Whoever puts it there. Before and after, it is the sample; light.power comes on top. */
typedef struct weft_rig_curtain {
    void *device;
    weft_code (*show)(void *device, weft_curtain scene, weft_error *error);
} weft_rig_curtain;

/* The texts are what session.json remembers of the rig. They belong to the back end. */
typedef struct weft_rig weft_rig;
struct weft_rig {
    const char *camera_name;   /* of one of several cameras: its folder in the session. NULL: there is one camera */
    const char *camera_model;  /* cameras of one model see the same colours; NULL: not known */
    const weft_colour *colour; /* of this camera under the lamp; NULL: that of the request, if any */
    weft_rig *first, *next; /* of several cameras; the earlier one takes a photograph that two could take. NULL: there
                               is one camera; next of the last: NULL */
    const char *name;       /* of the back end: "virtual" */
    const char *sample;     /* what lies in the opening of the target */
    const char *identity;   /* a JSON object with the settings and whatever else the photographs depend on: a session
                               goes on only where all its values are the same */
    weft_rig_settings settings;    /* set-up and exposure */
    weft_camera calibration;       /* of the camera */
    const char *lens_path;         /* file of the calibration; NULL: there is none */
    const weft_rig_poses *poses;   /* where the axes truly are, with the camera that goes with them; NULL: not known */
    const char *poses_path;        /* their file, for messages */
    weft_sensor_noise noise;       /* of a raw value */
    int dark_frames, flat_frames;  /* of the sensor, that a session begins with (docs/reference/session-format.md) */
    double seconds_per_photograph; /* beyond moving, as the operator knows it; 0: a rehearsal measures it on one */
    weft_rig_camera camera;
    weft_rig_stage stage;
    weft_rig_light light;
    weft_rig_curtain curtain; /* NULL: for sessions without frames of the sensor alone */
};

#endif
