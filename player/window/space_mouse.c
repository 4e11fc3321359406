#include "player/window/space_mouse.h"

#include <errno.h>
#include <fcntl.h>
#include <hidapi.h>
#include <stdio.h>
#include <stdlib.h>
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

void weft_space_mouse_report(const unsigned char *report, size_t size, weft_space_motion *motion)
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

static const double search_interval_s = 2;

struct weft_space_mouse {
    weft_space_mouse_state state;
    hid_device *handle; /* NULL while there is none */
    weft_space_motion motion;
    bool searched; /* at searched_s */
    double searched_s;
    char message[WEFT_MESSAGE_SIZE];
};

weft_code weft_space_mouse_create(weft_space_mouse **result, weft_error *error)
{
    *result = calloc(1, sizeof **result);
    return *result ? WEFT_OK : weft_fail_memory(error, "SpaceMouse", sizeof **result);
}

static void lose(weft_space_mouse *mouse)
{
    if (mouse->handle)
        hid_close(mouse->handle);
    mouse->handle = NULL;
    mouse->state = WEFT_SPACE_MOUSE_ABSENT;
    mouse->motion = (weft_space_motion){0};
    mouse->message[0] = 0;
}

void weft_space_mouse_free(weft_space_mouse *mouse)
{
    if (!mouse)
        return;
    lose(mouse);
    hid_exit();
    free(mouse);
}

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

/* The first multi-axis controller of 3Dconnexion's that opens. */
static void open_first(weft_space_mouse *mouse, const struct hid_device_info *list)
{
    for (const struct hid_device_info *info = list; info && !mouse->handle; info = info->next) {
        if (!is_space_mouse(info))
            continue;
        mouse->handle = hid_open_path(info->path);
        if (mouse->handle) {
            bool is_named = info->product_string && info->product_string[0];
            mouse->state = WEFT_SPACE_MOUSE_DEVICE;
            snprintf(mouse->message, sizeof mouse->message, "%ls", is_named ? info->product_string : L"SpaceMouse");
        } else if (is_forbidden(info->path)) {
            mouse->state = WEFT_SPACE_MOUSE_FORBIDDEN;
            snprintf(mouse->message, sizeof mouse->message,
                     "the SpaceMouse %s may not be read; run: sudo cp " WEFT_UDEV_RULE " /etc/udev/rules.d/ && "
                     "sudo udevadm control --reload && sudo udevadm trigger --subsystem-match=hidraw",
                     info->path);
        }
    }
}

static void search(weft_space_mouse *mouse)
{
    struct hid_device_info *list = hid_enumerate(0, 0);
    open_first(mouse, list);
    hid_free_enumeration(list);
}

/* Takes in the reports that have arrived. False where the device has gone. */
static bool read_reports(weft_space_mouse *mouse)
{
    for (int count = 0; count < MAX_REPORTS; count++) {
        unsigned char report[REPORT_SIZE];
        int size = hid_read_timeout(mouse->handle, report, sizeof report, 0);
        if (size <= 0)
            return size == 0;
        weft_space_mouse_report(report, (size_t)size, &mouse->motion);
    }
    return true;
}

weft_space_mouse_state weft_space_mouse_poll(weft_space_mouse *mouse, double now_s, weft_space_motion *motion)
{
    if (!mouse->handle && (!mouse->searched || now_s - mouse->searched_s >= search_interval_s)) {
        lose(mouse);
        mouse->searched = true;
        mouse->searched_s = now_s;
        search(mouse);
    }
    if (mouse->handle && !read_reports(mouse))
        lose(mouse);
    *motion = mouse->motion;
    return mouse->state;
}

const char *weft_space_mouse_message(const weft_space_mouse *mouse)
{
    return mouse->message;
}

/* ---- The camera ---- */

static const double dead_zone = 0.04;
static const double turn_rad_per_s = WEFT_PI, pan_pictures_per_s = 0.5, zoom_per_s = 1.4;
/* A loop that stood still (a window being moved, a file dialog) is no long push. */
static const double longest_step_s = 0.1;

static double speed_of(double deflection)
{
    if (!(fabs(deflection) > dead_zone))
        return 0;
    double beyond = (fmin(fabs(deflection), 1) - dead_zone) / (1 - dead_zone);
    return copysign(beyond * beyond, deflection);
}

bool weft_space_mouse_move(weft_orbit *orbit, const weft_space_motion *motion, double elapsed_s)
{
    double step_s = weft_clamp(elapsed_s, 0, longest_step_s);
    weft_orbit before = *orbit;
    double pan = 2 * weft_orbit_slope() * orbit->distance * pan_pictures_per_s * step_s;
    weft_orbit_turn(orbit, -turn_rad_per_s * step_s * speed_of(motion->rotation[1]),
                    turn_rad_per_s * step_s * speed_of(motion->rotation[0]));
    weft_orbit_pan(orbit, -pan * speed_of(motion->translation[0]), -pan * speed_of(motion->translation[1]));
    weft_orbit_zoom(orbit, exp(-zoom_per_s * step_s * speed_of(motion->translation[2])));
    return orbit->azimuth_rad != before.azimuth_rad || orbit->elevation_rad != before.elevation_rad ||
           orbit->distance != before.distance || orbit->pan_right != before.pan_right || orbit->pan_up != before.pan_up;
}
