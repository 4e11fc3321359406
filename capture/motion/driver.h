/* What turns axes, whatever they carry: behind it is a controller on USB, or nothing. Every call blocks. */
#ifndef WEFT_CAPTURE_STAGE_DRIVER_H
#define WEFT_CAPTURE_STAGE_DRIVER_H

#include "capture/axes/axes.h"

/* How a move ended that did not arrive. */
typedef enum weft_move_failure {
    WEFT_MOVE_LOST, /* the axes stand still but must be homed again; then it may be tried again */
    WEFT_MOVE_OVER  /* it makes no sense to try again */
} weft_move_failure;

typedef struct weft_axis_driver {
    void *device;
    /* Opens the device if need be, and drives the axes of the mask to their references. Errors: WEFT_SYSTEM; *failure
     * says what can be done, here and below. */
    weft_code (*home)(void *device, unsigned mask, weft_move_failure *failure, weft_error *error);
    /* Drives the axes of the mask, in one leg. OK only if all of them stand where they should. */
    weft_code (*move)(void *device, unsigned mask, const weft_axis_positions *to, weft_move_failure *failure,
                      weft_error *error);
    /* Whether they stand where the last move left them and have not been elsewhere. Errors: WEFT_SYSTEM. */
    weft_code (*held)(void *device, bool *held, weft_error *error);
    void (*stop)(void *device);
} weft_axis_driver;

/* What switches lamps. */
typedef struct weft_lamp_switch {
    void *device;
    /* Lamp `lamp` alone at a level from 0 to 1; -1: all off. Returns when it is known to be so. Errors: WEFT_SYSTEM. */
    weft_code (*set)(void *device, int lamp, double level, weft_error *error);
    /* In a copy of the process: forgets the connection, which is another's. `set` then opens one of its own, and waits
     * for nothing. */
    void (*abandon)(void *device);
} weft_lamp_switch;

#endif
