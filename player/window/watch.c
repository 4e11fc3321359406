#include "player/window/files.h"

#include <errno.h>
#include <limits.h>
#include <stdalign.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

static const double quiet_s = 0.3;
enum { MAX_READS = 64 }; /* a folder in which others are busy must not hold up the picture */

typedef struct slot {
    int folder; /* inotify's number; -1: nothing is watched */
    char *path;
    const char *name; /* in the folder */
    bool changed;
    double changed_s;
} slot;

struct weft_watch {
    int handle;
    slot slot[WEFT_WATCH_SLOTS];
};

weft_code weft_watch_create(weft_watch **result, weft_error *error)
{
    *result = NULL;
    weft_watch *watch = calloc(1, sizeof *watch);
    if (!watch)
        return weft_fail_memory(error, "watch", sizeof *watch);
    for (int i = 0; i < WEFT_WATCH_SLOTS; i++)
        watch->slot[i].folder = -1;
    watch->handle = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    if (watch->handle < 0) {
        free(watch);
        return weft_fail(error, WEFT_SYSTEM, "files cannot be watched: %s", strerror(errno));
    }
    *result = watch;
    return WEFT_OK;
}

void weft_watch_free(weft_watch *watch)
{
    if (!watch)
        return;
    close(watch->handle);
    for (int i = 0; i < WEFT_WATCH_SLOTS; i++)
        free(watch->slot[i].path);
    free(watch);
}

/* Slots of one folder share its number. */
static void leave(weft_watch *watch, int index)
{
    slot left = watch->slot[index];
    watch->slot[index] = (slot){.folder = -1};
    bool shared = false;
    for (int i = 0; i < WEFT_WATCH_SLOTS; i++)
        shared |= watch->slot[i].folder == left.folder;
    if (left.folder >= 0 && !shared)
        inotify_rm_watch(watch->handle, left.folder);
    free(left.path);
}

weft_code weft_watch_set(weft_watch *watch, int index, const char *path, weft_error *error)
{
    leave(watch, index);
    if (!path)
        return WEFT_OK;
    slot *s = &watch->slot[index];
    char folder[PATH_MAX] = ".";
    const char *slash = strrchr(path, '/');
    size_t length = slash ? (size_t)(slash - path) + 1 : 0;
    if (length >= sizeof folder)
        return weft_fail(error, WEFT_SYSTEM, "'%s' cannot be watched: its name is too long", path);
    if (slash) {
        memcpy(folder, path, length);
        folder[length] = 0;
    }
    s->path = strdup(path);
    if (!s->path)
        return weft_fail_memory(error, "name", strlen(path));
    s->name = s->path + length;
    s->folder = inotify_add_watch(watch->handle, folder, IN_CLOSE_WRITE | IN_MOVED_TO);
    return s->folder >= 0 ? WEFT_OK : weft_fail_errno(error, "watch", folder);
}

static void take_event(weft_watch *watch, const struct inotify_event *event, double now_s)
{
    for (int i = 0; i < WEFT_WATCH_SLOTS; i++) {
        slot *s = &watch->slot[i];
        if (s->folder != event->wd || event->len == 0 || strcmp(s->name, event->name) != 0)
            continue;
        s->changed = true;
        s->changed_s = now_s;
    }
}

static void take_events(weft_watch *watch, double now_s)
{
    alignas(struct inotify_event) char bytes[16 * (sizeof(struct inotify_event) + NAME_MAX + 1)];
    for (int round = 0; round < MAX_READS; round++) {
        ssize_t size = read(watch->handle, bytes, sizeof bytes);
        if (size <= 0)
            return;
        for (ssize_t at = 0; at < size;) {
            const struct inotify_event *event = (const void *)(bytes + at);
            take_event(watch, event, now_s);
            at += (ssize_t)sizeof *event + event->len;
        }
    }
}

int weft_watch_poll(weft_watch *watch, double now_s)
{
    struct stat status;
    take_events(watch, now_s);
    for (int i = 0; i < WEFT_WATCH_SLOTS; i++) {
        slot *s = &watch->slot[i];
        if (!s->changed || now_s - s->changed_s < quiet_s || stat(s->path, &status) != 0)
            continue;
        s->changed = false;
        return i;
    }
    return -1;
}
