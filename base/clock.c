#include "base/clock.h"

#include <poll.h>

static double now_s(void *context)
{
    (void)context;
    return weft_now_s();
}

static bool wait_for_input(void *context, int descriptor, double seconds)
{
    struct pollfd ready = {descriptor, POLLIN, 0};
    (void)context;
    return poll(&ready, 1, (int)(1000 * seconds)) > 0;
}

const weft_clock weft_system_clock = {.now_s = now_s, .wait_for_input = wait_for_input};
