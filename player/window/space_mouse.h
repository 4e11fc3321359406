/* A 3Dconnexion SpaceMouse, read through hidapi (hidraw), without a driver: a cap with six degrees of freedom that
 * turns, moves and nears what is looked at.
 *
 * Deflections are in the frame of the picture: x to the right, y up, z toward the user; rotations are right-handed
 * about these axes. 1 is the stop of the cap. One thread at a time. */
#ifndef WEFT_PLAYER_WINDOW_SPACE_MOUSE_H
#define WEFT_PLAYER_WINDOW_SPACE_MOUSE_H

#include "base/status.h"
#include "player/scene/orbit.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct weft_space_motion {
    double translation[3], rotation[3]; /* -1..1 */
    uint32_t buttons;                   /* bit k: button k is held */
} weft_space_motion;

typedef struct weft_space_mouse weft_space_mouse;

/* The result of a poll. */
typedef enum weft_space_mouse_state {
    WEFT_SPACE_MOUSE_ABSENT,    /* no device is plugged in */
    WEFT_SPACE_MOUSE_FORBIDDEN, /* a device may not be opened: weft_space_mouse_message says how to mend it */
    WEFT_SPACE_MOUSE_DEVICE     /* a device is read */
} weft_space_mouse_state;

/* Never fails for want of a device. The caller frees with weft_space_mouse_free. Errors: WEFT_SYSTEM. */
weft_code weft_space_mouse_create(weft_space_mouse **result, weft_error *error);
void weft_space_mouse_free(weft_space_mouse *mouse);

/* Reads what has arrived and gives the cap's present deflection; never waits. Without a device it looks for one every
 * 2 s. A device that goes away leaves the cap at rest. `now_s` is of any clock that never goes back. */
weft_space_mouse_state weft_space_mouse_poll(weft_space_mouse *mouse, double now_s, weft_space_motion *motion);

/* One line for the user: which device is read, or how to be allowed to; "" where there is none. Owned by `mouse`, valid
 * until the next poll. */
const char *weft_space_mouse_message(const weft_space_mouse *mouse);

/* The object follows the cap for elapsed_s: half a turn a second about the world's z and about the picture's x at the
 * stop, half the picture a second sideways, e-fold in 0.7 s nearer or farther. Deflections below a dead zone of 4 % do
 * nothing; beyond it the speed grows with the square. True where the orbit changed. Pure. */
bool weft_space_mouse_move(weft_orbit *orbit, const weft_space_motion *motion, double elapsed_s);

/* One input report, its number first: 1 translation (and rotation where it is as long), 2 rotation, 3 buttons; others,
 * and those that are too short, change nothing. Axes are 16-bit, little-endian, +-350 at the stop, in the device's
 * frame: x right, y toward the user, z down. Pure. */
void weft_space_mouse_report(const unsigned char *report, size_t size, weft_space_motion *motion);

#endif
