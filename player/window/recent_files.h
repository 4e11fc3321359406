/* The files that windows showed last, for the next window to offer: one path a line, the newest first, in
 * $XDG_STATE_HOME/weft/recent-files, or ~/.local/state/weft/recent-files. */
#ifndef WEFT_PLAYER_WINDOW_RECENT_FILES_H
#define WEFT_PLAYER_WINDOW_RECENT_FILES_H

#include "base/status.h"

enum { WEFT_RECENT_FILES_MOST = 10 };

/* Freed with weft_recent_files_free. */
typedef struct weft_recent_files {
    int count;
    char *path[WEFT_RECENT_FILES_MOST]; /* absolute */
    char *store;                        /* where they are kept; NULL: nowhere */
} weft_recent_files;

/* Reads the list, without files that are no longer there. It is empty where there is none, or where it cannot be read:
 * a window opens all the same. */
void weft_recent_files_read(weft_recent_files *recent);

/* Puts a file at the head of the list as other windows have stored it, once, and stores that if it changed. What is no
 * file, and a path that cannot be a line of the list, is left out. Two windows that store at the same moment: the later
 * one is right. Errors: WEFT_BAD_USAGE where the store is a folder and WEFT_SYSTEM from storing; the list has the file
 * all the same. */
weft_code weft_recent_files_add(weft_recent_files *recent, const char *path, weft_error *error);

void weft_recent_files_free(weft_recent_files *recent);

#endif
