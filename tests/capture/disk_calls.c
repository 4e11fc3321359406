#include "tests/capture/disk_calls.h"

#include <errno.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int __real_fdatasync(int descriptor);
int __real_fsync(int descriptor);
int __real_rename(const char *from, const char *to);
ssize_t __real_pwrite(int descriptor, const void *bytes, size_t size, off_t at);
int __wrap_fdatasync(int descriptor);
int __wrap_fsync(int descriptor);
int __wrap_rename(const char *from, const char *to);
ssize_t __wrap_pwrite(int descriptor, const void *bytes, size_t size, off_t at);

disk_call_visitor *disk_call_visit;

/* Whether the call is to be made. */
static bool visit(char event)
{
    int failure = disk_call_visit ? disk_call_visit(event) : 0;
    if (failure)
        errno = failure;
    return failure == 0;
}

static bool ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), tail = strlen(end);
    return length >= tail && strcmp(text + length - tail, end) == 0;
}

static void path_of(int descriptor, char path[PATH_MAX])
{
    char link[64];
    snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    ssize_t length = readlink(link, path, PATH_MAX - 1);
    path[length < 0 ? 0 : length] = '\0';
}

int __wrap_fdatasync(int descriptor)
{
    char path[PATH_MAX];
    path_of(descriptor, path);
    char event = ends_with(path, "/session/.photograph.tif") ? 'P'
                 : ends_with(path, "/session/journal.jsonl") ? 'J'
                                                             : '-';
    return visit(event) ? __real_fdatasync(descriptor) : -1;
}

int __wrap_fsync(int descriptor)
{
    char path[PATH_MAX];
    struct stat status;
    path_of(descriptor, path);
    bool of_session = fstat(descriptor, &status) == 0 && S_ISDIR(status.st_mode) && strstr(path, "/session");
    return visit(!of_session ? '-' : ends_with(path, "/session") ? 's' : 'v') ? __real_fsync(descriptor) : -1;
}

int __wrap_rename(const char *from, const char *to)
{
    return visit(ends_with(from, "/.photograph.tif") ? 'R' : '-') ? __real_rename(from, to) : -1;
}

ssize_t __wrap_pwrite(int descriptor, const void *bytes, size_t size, off_t at)
{
    char path[PATH_MAX];
    path_of(descriptor, path);
    return visit(ends_with(path, "/session/journal.jsonl") ? 'L' : '-') ? __real_pwrite(descriptor, bytes, size, at)
                                                                        : -1;
}
