/* What of a folder a window can open, for a list to choose from. */
#ifndef WEFT_PLAYER_WINDOW_FOLDER_FILES_H
#define WEFT_PLAYER_WINDOW_FOLDER_FILES_H

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

#endif
