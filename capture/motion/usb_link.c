#include "capture/motion/usb_link.h"

#include "base/clock.h"

#include <errno.h>
#include <hidapi.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <wchar.h>

static const char rule[] = "assets/udev/71-weft-capture.rules";

static bool is_wanted(const struct hid_device_info *info, const char *serial)
{
    wchar_t wide[256];
    if (!serial || !*serial)
        return true;
    size_t length = mbstowcs(wide, serial, 256);
    return length < 256 && info->serial_number && wcscmp(wide, info->serial_number) == 0;
}

/* One look. hidapi does not say why it could not open a device. */
static weft_code look(const weft_usb_address *address, hid_device **handle, weft_error *error)
{
    weft_code code = weft_fail(error, WEFT_SYSTEM, "there is no USB device %04x:%04x%s%s", address->vendor,
                               address->product, address->serial && *address->serial ? " with the serial number " : "",
                               address->serial ? address->serial : "");
    struct hid_device_info *list = hid_enumerate(address->vendor, address->product);
    for (const struct hid_device_info *info = list; info && code != WEFT_OK; info = info->next) {
        if (!is_wanted(info, address->serial))
            continue;
        *handle = hid_open_path(info->path);
        if (*handle)
            code = WEFT_OK;
        else if (access(info->path, R_OK | W_OK) != 0 && errno == EACCES)
            code = weft_fail(error, WEFT_SYSTEM, "'%s' may not be opened: install %s, then plug it in again",
                             info->path, rule);
        else
            code = weft_fail(error, WEFT_SYSTEM, "cannot open USB device '%s'", info->path);
    }
    hid_free_enumeration(list);
    return code;
}

weft_code weft_hid_open(const weft_usb_address *address, double wait_s, const volatile sig_atomic_t *stop,
                        hid_device **handle, weft_error *error)
{
    const struct timespec pause = {0, 50000000};
    double end_s = weft_now_s() + wait_s;
    weft_code code = look(address, handle, error);
    while (code != WEFT_OK && weft_now_s() < end_s) {
        if (stop && *stop)
            return weft_fail(error, WEFT_SYSTEM, "stopped while looking for USB device %04x:%04x", address->vendor,
                             address->product);
        nanosleep(&pause, NULL);
        code = look(address, handle, error);
    }
    return code;
}

/* ---- Opening ---- */

weft_code weft_usb_link_open(weft_usb_link *link, double wait_s, weft_error *error)
{
    weft_usb_link_close(link);
    return weft_hid_open(&link->address, wait_s, link->stop, (hid_device **)&link->handle, error);
}

void weft_usb_link_close(weft_usb_link *link)
{
    if (link->handle)
        hid_close(link->handle);
    link->handle = NULL;
}

/* ---- Asking ---- */

static bool send(weft_usb_link *link, const weft_stage_request *request)
{
    unsigned char report[1 + WEFT_REPORT_SIZE] = {0}; /* hidapi: the number of the report, 0 where there is one kind */
    weft_stage_request_pack(request, report + 1);
    return hid_write(link->handle, report, sizeof report) == (int)sizeof report;
}

/* Whether a report is the answer to what was asked just now. */
static bool is_answer(const weft_stage_request *request, const uint8_t *report, int size, weft_stage_reply *reply)
{
    if (size != WEFT_REPORT_SIZE || weft_stage_reply_unpack(report, reply) != WEFT_RESULT_DONE)
        return false;
    bool same = reply->sequence == request->sequence && reply->command == request->command;
    /* The request arrived broken: it is to be sent again, and the controller has said so under whatever number. */
    return same && reply->result != WEFT_RESULT_BAD_CRC;
}

/* Reads until the answer comes or the time is up. */
static weft_link_outcome listen(weft_usb_link *link, const weft_stage_request *request, weft_stage_reply *reply)
{
    double left_s = link->timeout_s, end_s = weft_now_s() + left_s;
    while (left_s > 0) {
        uint8_t report[WEFT_REPORT_SIZE];
        int size = hid_read_timeout(link->handle, report, sizeof report, (int)(left_s * 1000) + 1);
        if (size < 0)
            return WEFT_LINK_GONE;
        if (size > 0 && is_answer(request, report, size, reply))
            return WEFT_LINK_ANSWERED;
        left_s = end_s - weft_now_s();
    }
    return WEFT_LINK_SILENT;
}

weft_link_outcome weft_usb_link_ask(weft_usb_link *link, weft_stage_request *request, weft_stage_reply *reply)
{
    weft_link_outcome outcome = link->handle ? WEFT_LINK_SILENT : WEFT_LINK_GONE;
    request->sequence = ++link->sequence;
    for (int attempt = 0; outcome == WEFT_LINK_SILENT && attempt <= link->retries; attempt++)
        outcome = send(link, request) ? listen(link, request, reply) : WEFT_LINK_GONE;
    if (outcome == WEFT_LINK_GONE)
        weft_usb_link_close(link);
    return outcome;
}
