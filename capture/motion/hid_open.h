/* Finding a device on USB HID and opening it. */
#ifndef WEFT_CAPTURE_MOTION_HID_OPEN_H
#define WEFT_CAPTURE_MOTION_HID_OPEN_H

#include "capture/motion/usb_link.h"

#include <hidapi.h>

/* As weft_usb_link_open. The caller closes *handle with hid_close. */
weft_code weft_hid_open(const weft_usb_address *address, double wait_s, const volatile sig_atomic_t *stop,
                        hid_device **handle, weft_error *error);

#endif
