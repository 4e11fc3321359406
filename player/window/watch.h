/* Tells when files change on disk. */
#ifndef WEFT_PLAYER_WINDOW_WATCH_H
#define WEFT_PLAYER_WINDOW_WATCH_H

#include "base/status.h"

enum { WEFT_WATCH_SLOTS = 8 };

typedef struct weft_watch weft_watch;

/* Errors: WEFT_SYSTEM where the system gives no inotify. The caller frees with weft_watch_free. */
weft_code weft_watch_create(weft_watch **result, weft_error *error);
void weft_watch_free(weft_watch *watch);

/* Watches the file in this slot (0 .. WEFT_WATCH_SLOTS - 1) instead of what was watched there; NULL: nothing. The
 * file's folder is watched, so that a file that is written elsewhere and renamed counts, and one that is gone for a
 * while. Errors: WEFT_SYSTEM. */
weft_code weft_watch_set(weft_watch *watch, int slot, const char *path, weft_error *error);

/* A slot whose file was closed by a writer or renamed into place, and has been left alone for 0.3 s since; -1: none.
 * Never waits. `now_s` is of any clock that never goes back. */
int weft_watch_poll(weft_watch *watch, double now_s);

#endif
