/* Clocks of the system, and a clock that tests replace. */
#ifndef WEFT_BASE_CLOCK_H
#define WEFT_BASE_CLOCK_H

#include <stdbool.h>
#include <time.h>

/* Seconds on a clock of the system: CLOCK_MONOTONIC for the time that passes, CLOCK_THREAD_CPUTIME_ID or
 * CLOCK_PROCESS_CPUTIME_ID for processor time, which other programs on the machine do not lengthen. Only differences
 * mean something. Thread-safe. */
static inline double weft_clock_seconds(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Seconds that pass, whoever sets the time of day. Thread-safe. */
static inline double weft_now_s(void)
{
    return weft_clock_seconds(CLOCK_MONOTONIC);
}

/* The time, and waiting, for whatever must be tested without either. */
typedef struct weft_clock {
    void *context;
    double (*now_s)(void *context);
    /* Waits until there is something to read from `descriptor`, at most `seconds`. Returns whether there is. */
    bool (*wait_for_input)(void *context, int descriptor, double seconds);
} weft_clock;

/* weft_now_s and poll(). */
extern const weft_clock weft_system_clock;

#endif
