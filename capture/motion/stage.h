/* A stage of a laboratory behind the rig's interface: axes that a driver turns, axes that an operator turns, and lamps.
 */
#ifndef WEFT_CAPTURE_MOTION_STAGE_H
#define WEFT_CAPTURE_MOTION_STAGE_H

#include "capture/motion/controller.h"
#include "capture/rig.h"

/* Somebody who does what no motor does. Blocks until it is done. Errors: WEFT_SYSTEM where nobody is there. */
typedef struct weft_operator {
    void *context;
    weft_code (*ask)(void *context, const char *text, weft_error *error);
} weft_operator;

/* All borrowed. */
typedef struct weft_stage_parts {
    const weft_axes *axes;
    weft_controller *controller; /* of all axes that no operator turns; NULL: there are none */
    weft_lamp_switch lamps;      /* `set` NULL: the light burns anyway */
    const weft_angles *lamp;     /* [lamp_count] directions in the laboratory; 0: one lamp, wherever the axes put it */
    int lamp_count;
    double lamp_tolerance_rad; /* by which a lamp may differ from a light of the plan */
    double level, warm_up_s;   /* of the lamps, from 0 to 1; and how long they take to burn evenly */
    weft_operator rig_operator;
    int retries; /* of a move whose axes lost their references */
} weft_stage_parts;

typedef struct weft_stage weft_stage;

/* The caller frees with weft_stage_free. Errors: WEFT_SYSTEM for memory. */
weft_code weft_stage_create(const weft_stage_parts *parts, weft_stage **stage, weft_error *error);
void weft_stage_free(weft_stage *stage);

/* The same stage under another of several cameras, which differs in where it stands: `axes` (borrowed) are those of the
 * stage but for the fixed angles of the camera. The caller frees it before `stage`. Errors: WEFT_SYSTEM for memory. */
weft_code weft_stage_create_beside(weft_stage *stage, const weft_axes *axes, weft_stage **beside, weft_error *error);

/* The ways in. The stage stays the caller's. Poses whose references were lost are taken up again after homing, which
 * begins a new viewpoint. */
weft_rig_stage weft_stage_for_rig(weft_stage *stage);
weft_rig_light weft_stage_light(weft_stage *stage);

#endif
