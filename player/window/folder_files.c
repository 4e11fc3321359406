#include "player/window/files.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char *const endings[] = {".weft", ".btf.h5", ".wv", ".mc", ".obj", ".hdr", ".exr"};

static bool can_be_opened(const char *name)
{
    size_t length = strlen(name);
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        size_t ending = strlen(endings[i]);
        if (length > ending && strcmp(name + length - ending, endings[i]) == 0)
            return true;
    }
    return false;
}

static void forget(weft_folder_files *files)
{
    for (int i = 0; i < files->count; i++)
        free(files->path[i]);
    files->count = files->folder_count = 0;
    files->has_more = false;
}

/* Takes `path`, an owned one. */
static void put(weft_folder_files *files, char *path, bool is_folder)
{
    if (files->count == WEFT_FOLDER_FILES_MOST) {
        files->has_more = true;
        free(path);
        return;
    }
    files->path[files->count++] = path;
    if (is_folder) {
        /* The first file makes room. */
        char *file = files->path[files->folder_count];
        files->path[files->folder_count++] = path;
        files->path[files->count - 1] = file;
    }
}

static weft_code put_entry(weft_folder_files *files, const char *name, weft_error *error)
{
    struct stat status;
    char *path = NULL;
    if (name[0] == '.')
        return WEFT_OK;
    bool is_root = strcmp(files->folder, "/") == 0;
    if (asprintf(&path, "%s/%s", is_root ? "" : files->folder, name) < 0)
        return weft_fail_memory(error, "list of files", strlen(name));
    bool is_there = stat(path, &status) == 0, is_folder = is_there && S_ISDIR(status.st_mode);
    if (is_folder || (is_there && S_ISREG(status.st_mode) && can_be_opened(name)))
        put(files, path, is_folder);
    else
        free(path);
    return WEFT_OK;
}

static weft_code put_above(weft_folder_files *files, weft_error *error)
{
    const char *slash = strrchr(files->folder, '/');
    size_t length = slash && slash > files->folder ? (size_t)(slash - files->folder) : 1;
    char *above = strndup(files->folder, length);
    if (!above)
        return weft_fail_memory(error, "list of files", length);
    put(files, above, true);
    return WEFT_OK;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

weft_code weft_folder_files_read(weft_folder_files *files, const char *folder, weft_error *error)
{
    char whole[PATH_MAX];
    bool is_known = realpath(folder, whole);
    forget(files);
    if (!is_known)
        return WEFT_OK;
    snprintf(files->folder, sizeof files->folder, "%s", whole);
    weft_code code = put_above(files, error);
    DIR *listing = opendir(whole);
    for (struct dirent *entry; code == WEFT_OK && listing && (entry = readdir(listing));)
        code = put_entry(files, entry->d_name, error);
    if (listing)
        closedir(listing);
    if (code != WEFT_OK) {
        forget(files);
        return code;
    }
    qsort(files->path + 1, (size_t)files->folder_count - 1, sizeof *files->path, by_name);
    qsort(files->path + files->folder_count, (size_t)(files->count - files->folder_count), sizeof *files->path,
          by_name);
    return WEFT_OK;
}

void weft_folder_files_free(weft_folder_files *files)
{
    forget(files);
    files->folder[0] = 0;
}
