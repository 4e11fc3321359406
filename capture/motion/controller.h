/* The controller of a stage on USB (docs/reference/stage-protocol.md): axes, lamps and the contact of a shutter. */
#ifndef WEFT_CAPTURE_MOTION_CONTROLLER_H
#define WEFT_CAPTURE_MOTION_CONTROLLER_H

#include "capture/motion/driver.h"
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

/* The ways in. The controller stays the caller's. */
weft_axis_driver weft_controller_driver(weft_controller *controller);
weft_lamp_switch weft_controller_lamps(weft_controller *controller);

/* One pulse of the shutter's contact. Returns when it has begun. Errors: WEFT_SYSTEM. */
weft_code weft_controller_pulse(weft_controller *controller, double seconds, weft_error *error);

/* What went wrong and was put right. */
typedef struct weft_controller_log {
    int lost, damaged, stale; /* answers */
    int replugged, restarted; /* times that it was gone; and that it had lost its references then */
} weft_controller_log;
weft_controller_log weft_controller_get_log(const weft_controller *controller);

#endif
