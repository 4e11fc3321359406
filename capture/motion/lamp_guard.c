#include "capture/motion/lamps.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

struct weft_lamp_guard {
    weft_lamp_switch lamps;
    pid_t watcher; /* 0: none yet */
    int line;      /* to the watcher: it is cut when this process ends */
};

/* ---- The process that watches ---- */

enum { MOST_DESCRIPTORS = 65536 };

/* Of all that was open, only the line stays, as standard input. A lock on the session must not outlive its owner. */
static void keep_only(int line)
{
    long limit = sysconf(_SC_OPEN_MAX);
    dup2(line, STDIN_FILENO);
    for (int descriptor = STDOUT_FILENO; descriptor < (limit < MOST_DESCRIPTORS ? limit : MOST_DESCRIPTORS);
         descriptor++)
        close(descriptor);
    if (open("/dev/null", O_RDWR) == STDOUT_FILENO)
        dup2(STDOUT_FILENO, STDERR_FILENO);
}

static void watch(const weft_lamp_switch *lamps, int line)
{
    char word = 0;
    setsid();
    send(line, &word, 1, MSG_NOSIGNAL);
    keep_only(line);
    if (read(STDIN_FILENO, &word, 1) != 1) {
        lamps->abandon(lamps->device);
        lamps->set(lamps->device, -1, 0, NULL);
    }
    _exit(0);
}

/* No lamp burns before a signal from the terminal passes the watcher by. */
static weft_code wait_for_watcher(const weft_lamp_guard *guard, weft_error *error)
{
    char word;
    return read(guard->line, &word, 1) == 1
               ? WEFT_OK
               : weft_fail(error, WEFT_SYSTEM, "the process that watches the lamps ended at once");
}

static weft_code start(weft_lamp_guard *guard, weft_error *error)
{
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        return weft_fail_errno(error, "watch", "the lamps");
    pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        watch(&guard->lamps, ends[1]);
    }
    if (child < 0)
        weft_error_set_errno(error, "watch", "the lamps");
    close(ends[1]);
    guard->watcher = child > 0 ? child : 0;
    guard->line = ends[0];
    if (child < 0)
        close(ends[0]);
    return child < 0 ? WEFT_SYSTEM : wait_for_watcher(guard, error);
}

/* ---- The process that is watched ---- */

static weft_code set(void *device, int lamp, double level, weft_error *error)
{
    weft_lamp_guard *guard = device;
    if (lamp >= 0 && level > 0 && guard->watcher == 0)
        WEFT_TRY(start(guard, error));
    return guard->lamps.set(guard->lamps.device, lamp, level, error);
}

static void abandon(void *device)
{
    const weft_lamp_guard *guard = device;
    guard->lamps.abandon(guard->lamps.device);
}

weft_code weft_lamp_guard_create(weft_lamp_switch lamps, weft_lamp_guard **result, weft_error *error)
{
    weft_lamp_guard *guard = calloc(1, sizeof *guard);
    if (!guard)
        return weft_fail_memory(error, "lamps", sizeof *guard);
    guard->lamps = lamps;
    *result = guard;
    return WEFT_OK;
}

weft_lamp_switch weft_lamp_guard_lamps(weft_lamp_guard *guard)
{
    return (weft_lamp_switch){guard, set, abandon};
}

void weft_lamp_guard_free(weft_lamp_guard *guard)
{
    if (guard && guard->watcher > 0) {
        send(guard->line, "", 1, MSG_NOSIGNAL);
        close(guard->line);
        waitpid(guard->watcher, NULL, 0);
    }
    free(guard);
}
