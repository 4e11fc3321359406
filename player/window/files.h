/* The files of a folder that a window can open, for a list to choose from, and when they change on disk. */
#ifndef WEFT_PLAYER_WINDOW_FILES_H
#define WEFT_PLAYER_WINDOW_FILES_H

#include "base/status.h"

#include <limits.h>
#include <stdbool.h>

enum { WEFT_FOLDER_FILES_MOST = 200 };

/* The folder above, then folders, then files, each by name. Freed with weft_folder_files_free. */
typedef struct weft_folder_files {
    char folder[PATH_MAX]; /* absolute; "" before the first reading */
    int count, folder_count;
    char *path[WEFT_FOLDER_FILES_MOST]; /* absolute; the first folder_count are folders */
    bool has_more;                      /* than are listed */
} weft_folder_files;

/* Reads the list anew: folders, and files whose names end as those of materials, datasets, cloths, meshes or light do.
 * Names that begin with a dot are left out. A list of what cannot be read is empty, but for the folder above. `folder`
 * may be one of `files`. Errors: WEFT_SYSTEM for memory; the list is then empty. */
weft_code weft_folder_files_read(weft_folder_files *files, const char *folder, weft_error *error);

void weft_folder_files_free(weft_folder_files *files);

/* ---- When they change on disk ---- */

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
