#include "player/settings/json.h"

#include <errno.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Length of the folder in front of the last name, with its slash; 0 without a folder. */
static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

static weft_code real_folder(const char *path, char folder[PATH_MAX], weft_code missing, weft_error *error)
{
    size_t length = folder_length(path);
    char *given = length > 0 ? strndup(path, length) : strdup(".");
    if (!given)
        return weft_fail_memory(error, path, length);
    const char *found = realpath(given, folder);
    int reason = errno;
    free(given);
    if (!found)
        return weft_fail(error, missing, "the folder of '%s': %s", path, strerror(reason));
    return WEFT_OK;
}

/* Length of the folders that both paths begin with, without a slash at the end. */
static size_t common_length(const char *a, const char *b)
{
    size_t common = 0, i = 0;
    for (; a[i] && a[i] == b[i]; i++)
        if (a[i] == '/')
            common = i;
    bool a_ends = !a[i] || a[i] == '/', b_ends = !b[i] || b[i] == '/';
    return a_ends && b_ends ? i : common;
}

static int count_folders(const char *path)
{
    int count = 0;
    for (const char *at = path; *at; at++)
        count += *at == '/' && at[1];
    return count;
}

weft_code weft_path_relative_to(const char *path, const char *from, char **result, weft_error *error)
{
    char folder[PATH_MAX], base[PATH_MAX];
    WEFT_TRY(real_folder(path, folder, WEFT_BAD_INPUT, error));
    WEFT_TRY(real_folder(from, base, WEFT_SYSTEM, error));
    size_t common = common_length(folder, base);
    int up = common > 0 ? count_folders(base + common) : 0;
    const char *below = folder + common, *name = path + folder_length(path);
    below += *below == '/' && common > 0;
    *result = NULL;
    size_t size = 3 * (size_t)up + strlen(below) + strlen(name) + 2;
    char *text = calloc(size, 1);
    if (!text)
        return weft_fail_memory(error, path, size);
    for (char *at = text; at < text + 3 * (size_t)up; at += 3)
        snprintf(at, 4, "../");
    bool needs_slash = *below && below[strlen(below) - 1] != '/';
    snprintf(text + 3 * (size_t)up, size - 3 * (size_t)up, "%s%s%s", below, needs_slash ? "/" : "", name);
    *result = text;
    return WEFT_OK;
}

char *weft_path_beside(const char *name, const char *from)
{
    size_t length = name[0] == '/' ? 0 : folder_length(from);
    size_t size = length + strlen(name) + 1;
    char *path = malloc(size);
    if (!path)
        return NULL;
    snprintf(path, size, "%.*s%s", (int)length, from, name);
    return path;
}
