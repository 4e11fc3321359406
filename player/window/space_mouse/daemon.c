#include "player/window/space_mouse/daemon.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

enum { EVENT_MOTION, EVENT_PRESS, EVENT_RELEASE, EVENT_COUNT = 16 };
enum { LARGEST_DEFLECTION = 100000, MAX_BUTTONS = 32, MAX_PACKETS = 256 };

static const double full_deflection = 350; /* of the daemon at its sensitivity of 1 */

bool weft_space_daemon_open(weft_space_daemon *daemon)
{
    const char *path = getenv("SPNAV_SOCKET");
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    *daemon = (weft_space_daemon){.socket = -1};
    if (!path || !*path)
        path = "/run/spnav.sock";
    if (strlen(path) >= sizeof address.sun_path)
        return false;
    memcpy(address.sun_path, path, strlen(path) + 1);
    daemon->socket = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    return daemon->socket >= 0 && connect(daemon->socket, (struct sockaddr *)&address, sizeof address) == 0;
}

void weft_space_daemon_close(weft_space_daemon *daemon)
{
    if (daemon->socket >= 0)
        close(daemon->socket);
    *daemon = (weft_space_daemon){.socket = -1};
}

/* The daemon's frame has y up and z away from the user. */
static bool take_motion(const int32_t data[8], weft_space_motion *motion)
{
    static const double sign[3] = {1, 1, -1};
    for (int k = 1; k <= 6; k++) {
        if (data[k] < -LARGEST_DEFLECTION || data[k] > LARGEST_DEFLECTION)
            return false;
    }
    for (int k = 0; k < 3; k++) {
        motion->translation[k] = weft_clamp(sign[k] * data[1 + k] / full_deflection, -1, 1);
        motion->rotation[k] = weft_clamp(sign[k] * data[4 + k] / full_deflection, -1, 1);
    }
    return true;
}

static bool take_packet(const unsigned char packet[WEFT_SPACENAV_PACKET], weft_space_motion *motion)
{
    int32_t data[8];
    memcpy(data, packet, sizeof data);
    if (data[0] == EVENT_MOTION)
        return take_motion(data, motion);
    bool has_button = data[1] >= 0 && data[1] < MAX_BUTTONS;
    if (data[0] == EVENT_PRESS && has_button)
        motion->buttons |= UINT32_C(1) << data[1];
    else if (data[0] == EVENT_RELEASE && has_button)
        motion->buttons &= ~(UINT32_C(1) << data[1]);
    return data[0] > EVENT_MOTION && data[0] < EVENT_COUNT;
}

bool weft_space_daemon_poll(weft_space_daemon *daemon, weft_space_motion *motion)
{
    for (int count = 0; count < MAX_PACKETS;) {
        ssize_t size =
            recv(daemon->socket, daemon->packet + daemon->arrived, sizeof daemon->packet - daemon->arrived, 0);
        if (size < 0 && errno == EINTR)
            continue;
        if (size < 0)
            return errno == EAGAIN;
        if (size == 0)
            return false;
        daemon->arrived += (size_t)size;
        if (daemon->arrived < sizeof daemon->packet)
            continue;
        daemon->arrived = 0;
        count++;
        if (!take_packet(daemon->packet, motion))
            return false;
    }
    return true;
}
