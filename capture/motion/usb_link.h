/* Questions and answers over USB HID: what the cable does to them is settled here. */
#ifndef WEFT_CAPTURE_STAGE_USB_LINK_H
#define WEFT_CAPTURE_STAGE_USB_LINK_H

#include "base/status.h"
#include "capture/firmware/protocol.h"

#include <hidapi.h>
#include <signal.h>
#include <stdbool.h>

typedef struct weft_usb_address {
    unsigned short vendor, product;
    const char *serial; /* "" or NULL: the first one found; borrowed */
} weft_usb_address;

typedef struct weft_usb_link {
    weft_usb_address address;
    double timeout_s;
    int retries;
    const volatile sig_atomic_t *stop; /* borrowed; NULL: never */
    void *handle;                      /* of hidapi; NULL: not open */
    uint16_t sequence;
} weft_usb_link;

typedef enum weft_link_outcome {
    WEFT_LINK_ANSWERED,
    WEFT_LINK_GONE,  /* the device was unplugged; the link is closed */
    WEFT_LINK_SILENT /* plugged in, but nothing sensible comes back */
} weft_link_outcome;

/* Looks for the device for at most `wait_s` seconds, at once where that is 0, and opens it. Errors: WEFT_SYSTEM where
 * it is not there, may not be opened (naming the rule that would allow it), or `stop` was set. */
weft_code weft_usb_link_open(weft_usb_link *link, double wait_s, weft_error *error);
void weft_usb_link_close(weft_usb_link *link);

/* Asks, and asks again under the same sequence number where no sound answer comes within timeout_s, `retries` times.
 * The request's sequence number is set here. */
weft_link_outcome weft_usb_link_ask(weft_usb_link *link, weft_stage_request *request, weft_stage_reply *reply);

/* ---- Finding a device on USB HID and opening it. ---- */

/* As weft_usb_link_open. The caller closes *handle with hid_close. */
weft_code weft_hid_open(const weft_usb_address *address, double wait_s, const volatile sig_atomic_t *stop,
                        hid_device **handle, weft_error *error);

#endif
