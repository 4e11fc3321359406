/* The socket of spacenavd, the free driver for six-degree-of-freedom devices; its first protocol, which every version
 * of the daemon speaks to a client that asks for nothing: packets of eight 32-bit integers.
 *
 * Not libspnav: its spnav_open waits up to 0.3 s for an answer of newer daemons, a daemon that died looks like a cap at
 * rest, and a packet that arrives in parts is taken as whole. */
#ifndef WEFT_PLAYER_WINDOW_SPACE_MOUSE_DAEMON_H
#define WEFT_PLAYER_WINDOW_SPACE_MOUSE_DAEMON_H

#include "player/window/space_mouse/space_mouse.h"

#include <stddef.h>

enum { WEFT_SPACENAV_PACKET = 8 * sizeof(int32_t) };

typedef struct weft_space_daemon {
    int socket; /* -1 while there is none */
    unsigned char packet[WEFT_SPACENAV_PACKET];
    size_t arrived; /* bytes of it */
} weft_space_daemon;

/* Connects without waiting. False where nobody listens. The caller closes with weft_space_daemon_close, also on
 * failure. */
bool weft_space_daemon_open(weft_space_daemon *daemon);
void weft_space_daemon_close(weft_space_daemon *daemon);

/* Takes in what has arrived. False where the daemon has gone or sends what no daemon sends. */
bool weft_space_daemon_poll(weft_space_daemon *daemon, weft_space_motion *motion);

#endif
