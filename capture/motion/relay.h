/* USB relay boards that many laboratories own (16c0:05df, "USBRelay1" to "USBRelay8"): each relay switches a lamp. */
#ifndef WEFT_CAPTURE_MOTION_RELAY_H
#define WEFT_CAPTURE_MOTION_RELAY_H

#include "capture/motion/driver.h"
#include "capture/motion/usb_link.h"

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

/* The way in. A lamp burns or does not: a level above 0 is on. Each change is read back from the board. */
weft_lamp_switch weft_relay_lamps(weft_relay *relay);

#endif
