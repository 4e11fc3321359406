/* The controller of a stage on USB (docs/reference/stage-protocol.md): axes, lamps and the contact of a shutter. */
#ifndef WEFT_CAPTURE_MOTION_CONTROLLER_H
#define WEFT_CAPTURE_MOTION_CONTROLLER_H

#include "capture/axes/axes.h"
#include "capture/motion/lamps.h"
#include "capture/motion/usb_link.h"

typedef struct weft_controller_settings {
    weft_usb_address address;
    double timeout_s;                  /* of an answer */
    int retries;                       /* of a question */
    double replug_s;                   /* how long a controller that was unplugged is waited for */
    double poll_s;                     /* between questions while axes move */
    double tolerance_deg;              /* by which a position may differ from its target */
    const volatile sig_atomic_t *stop; /* borrowed; NULL: never */
} weft_controller_settings;

typedef struct weft_controller weft_controller;

/* Opens nothing yet. `axes` is borrowed. The caller frees with weft_controller_free. Errors: WEFT_SYSTEM for memory. */
weft_code weft_controller_create(const weft_controller_settings *settings, const weft_axes *axes,
                                 weft_controller **controller, weft_error *error);

/* Stops the axes and switches the lamps off, where it is open. */
void weft_controller_free(weft_controller *controller);

/* How a move ended that did not arrive. */
typedef enum weft_move_failure {
    WEFT_MOVE_LOST, /* the axes stand still but must be homed again; then it may be tried again */
    WEFT_MOVE_OVER  /* it makes no sense to try again */
} weft_move_failure;

/* Opens the controller if need be, and drives the axes of the mask to their references. Errors: WEFT_SYSTEM; *failure
 * says what can be done, here and below. */
weft_code weft_controller_home(weft_controller *controller, unsigned mask, weft_move_failure *failure,
                               weft_error *error);

/* Drives the axes of the mask, in one leg. OK only if all of them stand where they should. */
weft_code weft_controller_move(weft_controller *controller, unsigned mask, const weft_axis_positions *to,
                               weft_move_failure *failure, weft_error *error);

/* Whether the axes stand where the last move left them and have not been elsewhere. Errors: WEFT_SYSTEM. */
weft_code weft_controller_held(weft_controller *controller, bool *held, weft_error *error);

/* Stops all axes, where the controller is open. */
void weft_controller_stop(weft_controller *controller);

/* Its lamps. The controller stays the caller's. */
weft_lamp_switch weft_controller_lamps(weft_controller *controller);

/* One pulse of the shutter's contact. Returns when it has begun. Errors: WEFT_SYSTEM. */
weft_code weft_controller_pulse(weft_controller *controller, double seconds, weft_error *error);

#endif
