#include "player/window/recent_files.h"

#include "base/atomic_file.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { STORE_LIMIT = 1 << 16 };

/* NULL where the user has no home, or memory is short. The caller frees it. */
static char *find_store(void)
{
    const char *state = getenv("XDG_STATE_HOME"), *home = getenv("HOME");
    char *store = NULL;
    int length = -1;
    if (state && state[0] == '/')
        length = asprintf(&store, "%s/weft/recent-files", state);
    else if (home && home[0] == '/')
        length = asprintf(&store, "%s/.local/state/weft/recent-files", home);
    return length < 0 ? NULL : store;
}

/* Takes `path`, an owned one, to a place in the list; what falls off its end is freed. */
static void insert(weft_recent_files *recent, int place, char *path)
{
    if (recent->count == WEFT_RECENT_FILES_MOST)
        free(recent->path[--recent->count]);
    memmove(recent->path + place + 1, recent->path + place, (size_t)(recent->count - place) * sizeof *recent->path);
    recent->path[place] = path;
    recent->count++;
}

static int find(const weft_recent_files *recent, const char *path)
{
    for (int i = 0; i < recent->count; i++) {
        if (strcmp(recent->path[i], path) == 0)
            return i;
    }
    return -1;
}

static bool is_file(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode);
}

static void take_line(weft_recent_files *recent, const char *line)
{
    bool is_one = line[0] == '/' && recent->count < WEFT_RECENT_FILES_MOST && find(recent, line) < 0;
    char *path = is_one && is_file(line) ? strdup(line) : NULL;
    if (path)
        insert(recent, recent->count, path);
}

static void forget(weft_recent_files *recent)
{
    for (int i = 0; i < recent->count; i++)
        free(recent->path[i]);
    recent->count = 0;
}

/* Takes what the store has in place of the list; where it cannot be read the list stays. */
static void read_store(weft_recent_files *recent)
{
    char *text, *rest;
    size_t size;
    weft_error ignored;
    if (!recent->store || weft_read_file(recent->store, STORE_LIMIT, &text, &size, &ignored) != WEFT_OK)
        return;
    forget(recent);
    for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
        take_line(recent, line);
    free(text);
}

void weft_recent_files_read(weft_recent_files *recent)
{
    *recent = (weft_recent_files){.store = find_store()};
    read_store(recent);
}

/* ---- Storing ---- */

/* Its folder may not be there yet. */
static weft_code make_folder_of(const char *store, weft_error *error)
{
    char *folder = strdup(store);
    if (!folder)
        return weft_fail_memory(error, "recent files", strlen(store));
    *strrchr(folder, '/') = 0;
    weft_code code = weft_make_folder(folder, error);
    free(folder);
    return code;
}

static weft_code write_list(const weft_recent_files *recent, weft_error *error)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream)
        return weft_fail_memory(error, "recent files", 0);
    for (int i = 0; i < recent->count; i++)
        fprintf(stream, "%s\n", recent->path[i]);
    weft_code code = fclose(stream) == 0 ? WEFT_OK : weft_fail_memory(error, "recent files", size);
    if (code == WEFT_OK)
        code = weft_write_file(recent->store, text, size, error);
    free(text);
    return code;
}

weft_code weft_recent_files_add(weft_recent_files *recent, const char *path, weft_error *error)
{
    char *absolute = is_file(path) ? realpath(path, NULL) : NULL;
    read_store(recent);
    int place = absolute ? find(recent, absolute) : 0;
    if (!absolute || strchr(absolute, '\n') || (place == 0 && recent->count > 0)) {
        free(absolute);
        return WEFT_OK;
    }
    if (place > 0) {
        free(recent->path[place]);
        memmove(recent->path + place, recent->path + place + 1,
                (size_t)(--recent->count - place) * sizeof *recent->path);
    }
    insert(recent, 0, absolute);
    if (!recent->store)
        return WEFT_OK;
    WEFT_TRY(make_folder_of(recent->store, error));
    return write_list(recent, error);
}

void weft_recent_files_free(weft_recent_files *recent)
{
    forget(recent);
    free(recent->store);
    *recent = (weft_recent_files){0};
}
