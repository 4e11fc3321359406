/* What switches lamps, and what switches them off when the program is gone. */
#ifndef WEFT_CAPTURE_MOTION_LAMPS_H
#define WEFT_CAPTURE_MOTION_LAMPS_H

#include "capture/motion/usb_link.h"

/* What switches lamps. */
typedef struct weft_lamp_switch {
    void *device;
    /* Lamp `lamp` alone at a level from 0 to 1; -1: all off. Returns when it is known to be so. Errors: WEFT_SYSTEM. */
    weft_code (*set)(void *device, int lamp, double level, weft_error *error);
    /* In a copy of the process: forgets the connection, which is another's. `set` then opens one of its own, and waits
     * for nothing. */
    void (*abandon)(void *device);
} weft_lamp_switch;

/* ---- USB relay boards that many laboratories own (16c0:05df, "USBRelay1" to "USBRelay8") ---- */

typedef struct weft_relay_settings {
    weft_usb_address address;
    double replug_s; /* how long a board that was unplugged is waited for */
    int retries;
    const volatile sig_atomic_t *stop; /* borrowed; NULL: never */
} weft_relay_settings;

typedef struct weft_relay weft_relay;

/* Opens nothing yet. The caller frees with weft_relay_free. Errors: WEFT_SYSTEM for memory. */
weft_code weft_relay_create(const weft_relay_settings *settings, weft_relay **relay, weft_error *error);

/* Opens all relays, where the board is open. */
void weft_relay_free(weft_relay *relay);

/* A switch of lamps, one for each relay. A lamp burns or does not: a level above 0 is on. Each change is read back from
 * the board. */
weft_lamp_switch weft_relay_lamps(weft_relay *relay);

/* ---- Lamps that no program watches go dark: a second signal, SIGKILL and a crash leave no time to do it ---- */

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
