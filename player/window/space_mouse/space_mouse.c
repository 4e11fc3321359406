#include "player/window/space_mouse/space_mouse.h"

#include "player/window/space_mouse/daemon.h"
#include "player/window/space_mouse/device.h"

#include <stdio.h>
#include <stdlib.h>

static const double search_interval_s = 2;

struct weft_space_mouse {
    weft_space_mouse_state state;
    weft_space_daemon daemon;
    weft_space_device device;
    weft_space_motion motion;
    bool searched; /* at searched_s */
    double searched_s;
    char message[WEFT_MESSAGE_SIZE];
};

weft_code weft_space_mouse_create(weft_space_mouse **result, weft_error *error)
{
    *result = calloc(1, sizeof **result);
    if (!*result)
        return weft_fail_memory(error, "SpaceMouse", sizeof **result);
    (*result)->daemon.socket = -1;
    return WEFT_OK;
}

static void lose(weft_space_mouse *mouse)
{
    weft_space_daemon_close(&mouse->daemon);
    weft_space_device_close(&mouse->device);
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

static void describe(weft_space_mouse *mouse)
{
    if (mouse->state == WEFT_SPACE_MOUSE_DAEMON)
        snprintf(mouse->message, sizeof mouse->message, "SpaceMouse through spacenavd");
    else if (mouse->state == WEFT_SPACE_MOUSE_DEVICE)
        snprintf(mouse->message, sizeof mouse->message, "%s",
                 mouse->device.name[0] ? mouse->device.name : "SpaceMouse");
    else if (mouse->state == WEFT_SPACE_MOUSE_FORBIDDEN)
        snprintf(mouse->message, sizeof mouse->message,
                 "the SpaceMouse %s may not be read; run: sudo cp " WEFT_UDEV_RULE " /etc/udev/rules.d/ && "
                 "sudo udevadm control --reload && sudo udevadm trigger --subsystem-match=hidraw",
                 mouse->device.name);
}

static void search(weft_space_mouse *mouse)
{
    if (weft_space_daemon_open(&mouse->daemon)) {
        mouse->state = WEFT_SPACE_MOUSE_DAEMON;
    } else {
        weft_space_daemon_close(&mouse->daemon);
        mouse->state = weft_space_device_open(&mouse->device);
    }
    describe(mouse);
}

weft_space_mouse_state weft_space_mouse_poll(weft_space_mouse *mouse, double now_s, weft_space_motion *motion)
{
    bool is_read = mouse->state == WEFT_SPACE_MOUSE_DAEMON || mouse->state == WEFT_SPACE_MOUSE_DEVICE;
    if (!is_read && (!mouse->searched || now_s - mouse->searched_s >= search_interval_s)) {
        lose(mouse);
        mouse->searched = true;
        mouse->searched_s = now_s;
        search(mouse);
    }
    if (mouse->state == WEFT_SPACE_MOUSE_DAEMON && !weft_space_daemon_poll(&mouse->daemon, &mouse->motion))
        lose(mouse);
    if (mouse->state == WEFT_SPACE_MOUSE_DEVICE && !weft_space_device_poll(&mouse->device, &mouse->motion))
        lose(mouse);
    *motion = mouse->motion;
    return mouse->state;
}

const char *weft_space_mouse_message(const weft_space_mouse *mouse)
{
    return mouse->message;
}
