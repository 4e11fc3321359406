#include "player/window/space_mouse/device.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

/* HID usage tables: generic desktop page, multi-axis controller. */
enum { USAGE_PAGE_DESKTOP = 1, USAGE_MULTI_AXIS = 8 };
/* 3Dconnexion's own number, and that of Logitech, under which its older devices were sold. */
enum { VENDOR_3DCONNEXION = 0x256f, VENDOR_LOGITECH = 0x046d };
enum { REPORT_TRANSLATION = 1, REPORT_ROTATION, REPORT_BUTTONS };
enum { AXES_SIZE = 6, REPORT_SIZE = 64, MAX_REPORTS = 256 };

static const double full_deflection = 350;

/* ---- Reports ---- */

static void take_axes(const unsigned char bytes[AXES_SIZE], double axis[3])
{
    double device[3];
    for (int k = 0; k < 3; k++) {
        int16_t value = (int16_t)(bytes[2 * k] | bytes[2 * k + 1] << 8);
        device[k] = weft_clamp(value / full_deflection, -1, 1);
    }
    axis[0] = device[0];
    axis[1] = -device[2];
    axis[2] = device[1];
}

void weft_space_device_report(const unsigned char *report, size_t size, weft_space_motion *motion)
{
    if (size < 2)
        return;
    if (report[0] == REPORT_TRANSLATION && size > AXES_SIZE) {
        take_axes(report + 1, motion->translation);
        if (size > 2 * AXES_SIZE)
            take_axes(report + 1 + AXES_SIZE, motion->rotation);
    } else if (report[0] == REPORT_ROTATION && size > AXES_SIZE) {
        take_axes(report + 1, motion->rotation);
    } else if (report[0] == REPORT_BUTTONS) {
        motion->buttons = 0;
        for (size_t k = 1; k < size && k <= 4; k++)
            motion->buttons |= (uint32_t)report[k] << 8 * (k - 1);
    }
}

/* ---- The device ---- */

static bool is_space_mouse(const struct hid_device_info *info)
{
    bool is_maker = info->vendor_id == VENDOR_3DCONNEXION || info->vendor_id == VENDOR_LOGITECH;
    return is_maker && info->usage_page == USAGE_PAGE_DESKTOP && info->usage == USAGE_MULTI_AXIS;
}

/* hidapi does not say why it could not open a device. */
static bool is_forbidden(const char *path)
{
    int node = open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (node < 0)
        return errno == EACCES || errno == EPERM;
    close(node);
    return false;
}

static weft_space_mouse_state open_first(const struct hid_device_info *list, weft_space_device *device)
{
    weft_space_mouse_state state = WEFT_SPACE_MOUSE_ABSENT;
    for (const struct hid_device_info *info = list; info; info = info->next) {
        if (!is_space_mouse(info))
            continue;
        device->handle = hid_open_path(info->path);
        if (device->handle) {
            snprintf(device->name, sizeof device->name, "%ls", info->product_string ? info->product_string : L"");
            return WEFT_SPACE_MOUSE_DEVICE;
        }
        if (is_forbidden(info->path)) {
            snprintf(device->name, sizeof device->name, "%s", info->path);
            state = WEFT_SPACE_MOUSE_FORBIDDEN;
        }
    }
    return state;
}

weft_space_mouse_state weft_space_device_open(weft_space_device *device)
{
    *device = (weft_space_device){0};
    struct hid_device_info *list = hid_enumerate(0, 0);
    weft_space_mouse_state state = open_first(list, device);
    hid_free_enumeration(list);
    return state;
}

void weft_space_device_close(weft_space_device *device)
{
    if (device->handle)
        hid_close(device->handle);
    *device = (weft_space_device){0};
}

bool weft_space_device_poll(weft_space_device *device, weft_space_motion *motion)
{
    for (int count = 0; count < MAX_REPORTS; count++) {
        unsigned char report[REPORT_SIZE];
        int size = hid_read_timeout(device->handle, report, sizeof report, 0);
        if (size < 0)
            return false;
        if (size == 0)
            return true;
        weft_space_device_report(report, (size_t)size, motion);
    }
    return true;
}
