/* Lamps that no program watches go dark: a second signal, SIGKILL and a crash leave no time to switch them off. */
#ifndef WEFT_CAPTURE_MOTION_LAMP_GUARD_H
#define WEFT_CAPTURE_MOTION_LAMP_GUARD_H

#include "capture/motion/driver.h"

typedef struct weft_lamp_guard weft_lamp_guard;

/* Guards `lamps`, whose device is borrowed. The caller frees with weft_lamp_guard_free. Errors: WEFT_SYSTEM for
 * memory. */
weft_code weft_lamp_guard_create(weft_lamp_switch lamps, weft_lamp_guard **guard, weft_error *error);

/* The same lamps, watched: before the first one burns, a process is started that waits until this one has ended, opens
 * the device itself, and switches all lamps off. Signals of a terminal do not reach it. What kills both processes at
 * once leaves a lamp on. `set` also fails with WEFT_SYSTEM where that process cannot be started. Not thread safe. */
weft_lamp_switch weft_lamp_guard_lamps(weft_lamp_guard *guard);

/* Ends the process beside this one; it switches nothing. NULL is allowed. */
void weft_lamp_guard_free(weft_lamp_guard *guard);

#endif
