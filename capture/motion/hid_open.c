#include "capture/motion/hid_open.h"

#include "base/clock.h"

#include <errno.h>
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
