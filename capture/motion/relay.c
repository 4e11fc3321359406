#include "capture/motion/lamps.h"

#include "capture/motion/usb_link.h"

#include <stdlib.h>
#include <string.h>

/* Feature reports of eight bytes. Written: what to do, then the relay from 1. Read: five letters of a serial number,
 * two unused, then a mask of the relays that are closed. */
enum { CLOSE_ONE = 0xff, OPEN_ALL = 0xfc, REPORT = 9, MASK = 8, RELAYS = 8 };

struct weft_relay {
    weft_relay_settings settings;
    hid_device *handle;
    bool was_open;
};

static void close_board(weft_relay *relay)
{
    if (relay->handle)
        hid_close(relay->handle);
    relay->handle = NULL;
}

static bool send(weft_relay *relay, unsigned char what, unsigned char number)
{
    const unsigned char report[REPORT] = {0, what, number};
    return hid_send_feature_report(relay->handle, report, sizeof report) == REPORT;
}

/* hidapi before 0.14 counts the number of the report or not, as the board answers. */
static bool read_mask(weft_relay *relay, unsigned *mask)
{
    unsigned char report[REPORT] = {0};
    int size = hid_get_feature_report(relay->handle, report, sizeof report);
    *mask = size == REPORT ? report[MASK] : report[MASK - 1];
    return size >= REPORT - 1;
}

/* Only one at a time: what was on goes off first. */
static bool set_once(weft_relay *relay, int lamp, bool on)
{
    unsigned mask, wanted = on ? 1u << lamp : 0;
    bool sent = send(relay, OPEN_ALL, 0) && (!on || send(relay, CLOSE_ONE, (unsigned char)(lamp + 1)));
    return sent && read_mask(relay, &mask) && mask == wanted;
}

static weft_code set(void *device, int lamp, double level, weft_error *error)
{
    weft_relay *relay = device;
    bool on = lamp >= 0 && level > 0;
    if (lamp >= RELAYS)
        return weft_fail(error, WEFT_SYSTEM, "relay board: there is no relay %d", lamp + 1);
    for (int attempt = 0; attempt <= relay->settings.retries; attempt++) {
        if (!relay->handle)
            WEFT_TRY(weft_hid_open(&relay->settings.address, relay->was_open ? relay->settings.replug_s : 0,
                                   relay->settings.stop, &relay->handle, error));
        relay->was_open = true;
        if (set_once(relay, lamp, on))
            return WEFT_OK;
        close_board(relay);
    }
    return weft_fail(error, WEFT_SYSTEM, "relay board: relay %d does not switch %s", lamp + 1, on ? "on" : "off");
}

static void abandon(void *device)
{
    weft_relay *relay = device;
    relay->handle = NULL;
    relay->was_open = false;
    relay->settings.stop = NULL;
}

weft_code weft_relay_create(const weft_relay_settings *settings, weft_relay **result, weft_error *error)
{
    weft_relay *relay = calloc(1, sizeof *relay);
    if (!relay)
        return weft_fail_memory(error, "relay board", sizeof *relay);
    relay->settings = *settings;
    *result = relay;
    return WEFT_OK;
}

void weft_relay_free(weft_relay *relay)
{
    if (!relay)
        return;
    if (relay->handle)
        send(relay, OPEN_ALL, 0);
    close_board(relay);
    free(relay);
}

weft_lamp_switch weft_relay_lamps(weft_relay *relay)
{
    return (weft_lamp_switch){relay, set, abandon};
}
