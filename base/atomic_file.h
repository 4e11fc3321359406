/* Files that are never half-written: written under a temporary name beside their final place,
 * synced, then renamed. */
#ifndef WEFT_BASE_ATOMIC_FILE_H
#define WEFT_BASE_ATOMIC_FILE_H

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A path being written. Owned by the caller; begin, then exactly one of commit or abandon. */
typedef struct weft_atomic_file {
    char *final_path;     /* of a link: what it points to */
    char *temporary_path; /* in the same folder, unique to this process, same extension */
} weft_atomic_file;

/* Chooses the temporary path; creates nothing. Errors: WEFT_BAD_USAGE where `path` names no file, or
 * a folder, device or pipe; WEFT_SYSTEM for memory, or where its folder does not exist or is not writable. */
weft_code weft_atomic_file_begin(const char *path, weft_atomic_file *file, weft_error *error);

/* Whether a file could be begun there: one is, and goes away again. Errors: as above. */
weft_code weft_output_check(const char *path, weft_error *error);

/* Syncs the temporary file to disk, renames it to its final name and syncs the folder. A file that is replaced keeps
 * its permissions. On failure the temporary file is removed and the final one is as it was. Frees `file` either way. */
weft_code weft_atomic_file_commit(weft_atomic_file *file, weft_error *error);

/* Removes the temporary file, if it exists, and frees `file`. Harmless after commit. */
void weft_atomic_file_abandon(weft_atomic_file *file);

/* Whether `name` is that of a temporary file, of any process, for a file called `file_name`; both without a folder.
 * Pure.
 */
bool weft_is_left_over(const char *name, const char *file_name);

/* Removes the temporary files of `path` that processes left which died while they wrote it. The caller is the only one
 * who writes it. */
void weft_sweep_left_over(const char *path);

/* The whole of begin, write, commit for `size` bytes in memory. */
weft_code weft_write_file(const char *path, const void *bytes, size_t size, weft_error *error);

/* Writes `size` bytes under a name that the caller renames later; no sync. A file that cannot be written whole is
 * removed. Errors: WEFT_SYSTEM. */
weft_code weft_write_new_file(const char *path, const void *bytes, size_t size, weft_error *error);

/* Waits until the contents of a file are on the disk. Its name may not be: see weft_sync_folder_of. Errors:
 * WEFT_SYSTEM. */
weft_code weft_sync_file(const char *path, weft_error *error);

/* Waits until the names in the folder of `path` are on the disk. Not every file system can; nothing is said then. */
void weft_sync_folder_of(const char *path);

/* The code for a file that could not be opened or read, by its errno: WEFT_MISSING where there is none,
 * WEFT_OUT_OF_MEMORY, WEFT_SYSTEM where the disk or the number of open files is at fault, else WEFT_BAD_INPUT. Pure. */
weft_code weft_code_of_reading(int number);

/* Fills the error with "cannot ACTION 'PATH': strerror(errno)"; returns weft_code_of_reading(errno). */
weft_code weft_fail_reading(weft_error *error, const char *action, const char *path);

/* Reads a whole file. *bytes is NUL-terminated beyond *size, owned by the caller (free). Errors: weft_code_of_reading;
 * WEFT_BAD_INPUT where it is a folder, or larger than `limit` bytes; WEFT_DAMAGED where it ends early. */
weft_code weft_read_file(const char *path, size_t limit, char **bytes, size_t *size, weft_error *error);

/* The size of a file; 0 where there is none. */
uint64_t weft_file_bytes(const char *path);

/* Whether both paths lead to one and the same file that exists. */
bool weft_is_same_file(const char *a, const char *b);

/* Whether a folder could be made there, or written into: a file is, and goes away again. Errors: WEFT_SYSTEM. */
weft_code weft_output_folder_check(const char *path, weft_error *error);

/* Creates a folder and its parents; an existing folder is fine. */
weft_code weft_make_folder(const char *path, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif
