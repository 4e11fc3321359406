#include "capture/motion/usb_link.h"

#include "base/clock.h"
#include "capture/motion/hid_open.h"

#include <hidapi.h>
#include <string.h>

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
static bool is_answer(weft_usb_link *link, const weft_stage_request *request, const uint8_t *report, int size,
                      weft_stage_reply *reply)
{
    if (size != WEFT_REPORT_SIZE || weft_stage_reply_unpack(report, reply) != WEFT_RESULT_DONE) {
        link->damaged++;
        return false;
    }
    bool same = reply->sequence == request->sequence && reply->command == request->command;
    if (!same)
        link->stale++;
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
        if (size > 0 && is_answer(link, request, report, size, reply))
            return WEFT_LINK_ANSWERED;
        left_s = end_s - weft_now_s();
    }
    link->lost++;
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
