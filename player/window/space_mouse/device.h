/* A 3Dconnexion device read through hidapi (hidraw), without a driver. */
#ifndef WEFT_PLAYER_WINDOW_SPACE_MOUSE_DEVICE_H
#define WEFT_PLAYER_WINDOW_SPACE_MOUSE_DEVICE_H

#include "player/window/space_mouse/space_mouse.h"

#include <hidapi.h>
#include <stddef.h>

typedef struct weft_space_device {
    hid_device *handle; /* NULL while there is none */
    char name[64];      /* of the product, or of the node that may not be opened */
} weft_space_device;

/* Opens the first multi-axis controller of 3Dconnexion's. Gives ABSENT, FORBIDDEN (name: its node) or DEVICE. The
 * caller closes with weft_space_device_close. */
weft_space_mouse_state weft_space_device_open(weft_space_device *device);
void weft_space_device_close(weft_space_device *device);

/* Takes in the reports that have arrived. False where the device has gone. */
bool weft_space_device_poll(weft_space_device *device, weft_space_motion *motion);

/* One input report, its number first: 1 translation (and rotation where it is as long), 2 rotation, 3 buttons; others,
 * and those that are too short, change nothing. Axes are 16-bit, little-endian, +-350 at the stop, in the device's
 * frame: x right, y toward the user, z down. Pure. */
void weft_space_device_report(const unsigned char *report, size_t size, weft_space_motion *motion);

#endif
