#include "base/atomic_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void forget(weft_atomic_file *file)
{
    free(file->final_path);
    free(file->temporary_path);
    *file = (weft_atomic_file){0};
}

/* Writes the folder part of `path` ("." where it has none) into `folder`. */
static void folder_of(const char *path, char folder[PATH_MAX])
{
    char copy[PATH_MAX];
    snprintf(copy, sizeof copy, "%s", path);
    snprintf(folder, PATH_MAX, "%s", dirname(copy));
}

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Where the extension begins; the end of the name where there is none. */
static const char *extension_of(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && dot != name ? dot : name + strlen(name);
}

/* "a/b.c.png" becomes "a/.b.c.PID.png": the extension stays, because writers choose the format by it. */
static char *temporary_name(const char *path)
{
    const char *name = name_of(path), *dot = extension_of(name);
    char *result = NULL;
    if (asprintf(&result, "%.*s.%.*s.%ld%s", (int)(name - path), path, (int)(dot - name), name, (long)getpid(), dot) <
        0)
        return NULL;
    return result;
}

bool weft_is_left_over(const char *name, const char *file_name)
{
    const char *extension = extension_of(file_name);
    size_t stem = (size_t)(extension - file_name), length = strlen(name), last = strlen(extension);
    if (length <= stem + 2 + last || name[0] != '.' || name[stem + 1] != '.')
        return false;
    const char *number = name + stem + 2, *end = name + length - last;
    return strncmp(name + 1, file_name, stem) == 0 && strcmp(end, extension) == 0 &&
           strspn(number, "0123456789") == (size_t)(end - number);
}

void weft_sweep_left_over(const char *path)
{
    char folder[PATH_MAX];
    folder_of(path, folder);
    DIR *listing = opendir(folder);
    if (!listing)
        return;
    for (struct dirent *entry; (entry = readdir(listing));) {
        if (weft_is_left_over(entry->d_name, name_of(path)))
            unlinkat(dirfd(listing), entry->d_name, 0);
    }
    closedir(listing);
}

/* A rename would put a file in the place of a device or pipe. */
static weft_code check_name(const char *path, weft_error *error)
{
    struct stat status;
    size_t length = strlen(path);
    if (length >= PATH_MAX - 32)
        return weft_fail(error, WEFT_BAD_USAGE, "path is too long (%zu bytes): '%.60s...'", length, path);
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode))
        return weft_fail(error, WEFT_BAD_USAGE, "cannot write '%s': it is %s", path,
                         S_ISDIR(status.st_mode) ? "a folder" : "not a regular file");
    if (length == 0 || path[length - 1] == '/')
        return weft_fail(error, WEFT_BAD_USAGE, "cannot write '%s': it does not name a file", path);
    return WEFT_OK;
}

static weft_code check_folder(const char *path, weft_error *error)
{
    char folder[PATH_MAX];
    struct stat status;
    folder_of(path, folder);
    if (stat(folder, &status) == 0 && !S_ISDIR(status.st_mode))
        return weft_fail(error, WEFT_SYSTEM, "cannot write '%s': '%s' is a file", path, folder);
    return access(folder, W_OK | X_OK) == 0 ? WEFT_OK : weft_fail_errno(error, "write into folder", folder);
}

/* A link stays, and what it points to is replaced. */
static char *final_name(const char *path)
{
    struct stat status;
    bool is_link = lstat(path, &status) == 0 && S_ISLNK(status.st_mode);
    char *target = is_link ? realpath(path, NULL) : NULL;
    return target ? target : strdup(path);
}

/* Permissions do not say it all: the kernel lets root write into /proc, but no file can be made there. */
static weft_code try_folder(const char *folder, weft_error *error)
{
    char *path = NULL;
    if (asprintf(&path, "%s/.weft-XXXXXX", folder) < 0)
        return weft_fail_memory(error, "file name", strlen(folder));
    int descriptor = mkostemp(path, O_CLOEXEC);
    weft_code code = descriptor >= 0 ? WEFT_OK : weft_fail_errno(error, "write into folder", folder);
    if (descriptor >= 0) {
        close(descriptor);
        unlink(path);
    }
    free(path);
    return code;
}

weft_code weft_output_check(const char *path, weft_error *error)
{
    char folder[PATH_MAX];
    WEFT_TRY(check_name(path, error));
    WEFT_TRY(check_folder(path, error));
    folder_of(path, folder);
    return try_folder(folder, error);
}

weft_code weft_atomic_file_begin(const char *path, weft_atomic_file *file, weft_error *error)
{
    *file = (weft_atomic_file){0};
    WEFT_TRY(check_name(path, error));
    file->final_path = final_name(path);
    file->temporary_path = file->final_path ? temporary_name(file->final_path) : NULL;
    weft_code code = file->temporary_path ? check_folder(file->final_path, error)
                                          : weft_fail_memory(error, "file name", strlen(path));
    if (code != WEFT_OK)
        forget(file);
    return code;
}

static int sync_path(const char *path, int flags)
{
    int descriptor = open(path, flags | O_CLOEXEC);
    if (descriptor < 0)
        return -1;
    int result = fsync(descriptor);
    int saved = errno;
    close(descriptor);
    errno = saved;
    return result;
}

weft_code weft_sync_file(const char *path, weft_error *error)
{
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    int result = descriptor < 0 ? -1 : fdatasync(descriptor), saved = errno;
    if (descriptor >= 0)
        close(descriptor);
    errno = saved;
    return result == 0 ? WEFT_OK : weft_fail_errno(error, "sync", path);
}

void weft_sync_folder_of(const char *path)
{
    char folder[PATH_MAX];
    folder_of(path, folder);
    sync_path(folder, O_RDONLY | O_DIRECTORY);
}

/* A file that is replaced keeps its permissions and, where the system lets us, its owner. A new one has what the umask
 * of its writer left. Not every file system has permissions: then nothing is lost. */
static void keep_permissions(const weft_atomic_file *file)
{
    struct stat before;
    if (stat(file->final_path, &before) != 0)
        return;
    bool is_owned = chown(file->temporary_path, before.st_uid, before.st_gid) == 0;
    mode_t others = is_owned ? 0 : S_ISUID | S_ISGID;
    (void)!chmod(file->temporary_path, before.st_mode & 07777 & ~others);
}

weft_code weft_atomic_file_commit(weft_atomic_file *file, weft_error *error)
{
    weft_code code = WEFT_OK;
    keep_permissions(file);
    if (sync_path(file->temporary_path, O_RDONLY) != 0 || rename(file->temporary_path, file->final_path) != 0) {
        code = weft_fail_errno(error, "write", file->final_path);
        unlink(file->temporary_path);
    } else {
        weft_sync_folder_of(file->final_path);
    }
    forget(file);
    return code;
}

void weft_atomic_file_abandon(weft_atomic_file *file)
{
    if (file->temporary_path)
        unlink(file->temporary_path);
    forget(file);
}

static int write_all(int descriptor, const char *bytes, size_t size)
{
    while (size > 0) {
        ssize_t written = write(descriptor, bytes, size);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return -1;
        bytes += written;
        size -= (size_t)written;
    }
    return 0;
}

static int create_and_write(const char *path, const void *bytes, size_t size)
{
    int descriptor = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0)
        return -1;
    int result = write_all(descriptor, bytes, size);
    int saved = errno;
    if (close(descriptor) != 0)
        return -1;
    errno = saved;
    return result;
}

weft_code weft_write_file(const char *path, const void *bytes, size_t size, weft_error *error)
{
    weft_atomic_file file;
    WEFT_TRY(weft_atomic_file_begin(path, &file, error));
    if (create_and_write(file.temporary_path, bytes, size) != 0) {
        weft_code code = weft_fail_errno(error, "write", path);
        weft_atomic_file_abandon(&file);
        return code;
    }
    return weft_atomic_file_commit(&file, error);
}

weft_code weft_write_new_file(const char *path, const void *bytes, size_t size, weft_error *error)
{
    if (create_and_write(path, bytes, size) == 0)
        return WEFT_OK;
    weft_code code = weft_fail_errno(error, "write", path);
    unlink(path);
    return code;
}

weft_code weft_code_of_reading(int number)
{
    switch (number) {
    case ENOENT:
    case ENOTDIR:
        return WEFT_MISSING;
    case ENOMEM:
        return WEFT_OUT_OF_MEMORY;
    case EIO:
    case EMFILE:
    case ENFILE:
        return WEFT_SYSTEM;
    default:
        return WEFT_BAD_INPUT;
    }
}

weft_code weft_fail_reading(weft_error *error, const char *action, const char *path)
{
    weft_code code = weft_code_of_reading(errno);
    return weft_fail(error, code, "cannot %s '%s': %s", action, path, strerror(errno));
}

static weft_code read_descriptor(int descriptor, const char *path, size_t size, char **bytes, weft_error *error)
{
    char *buffer = malloc(size + 1);
    if (!buffer)
        return weft_fail_memory(error, path, size);
    size_t done = 0;
    while (done < size) {
        ssize_t got = read(descriptor, buffer + done, size - done);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0) {
            weft_code code = got < 0 ? weft_code_of_reading(errno) : WEFT_DAMAGED;
            free(buffer);
            return weft_fail(error, code, "cannot read '%s': %s after %zu of %zu bytes", path,
                             got < 0 ? strerror(errno) : "the file ends", done, size);
        }
        done += (size_t)got;
    }
    buffer[size] = '\0';
    *bytes = buffer;
    return WEFT_OK;
}

weft_code weft_read_file(const char *path, size_t limit, char **bytes, size_t *size, weft_error *error)
{
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
        return weft_fail_reading(error, "open", path);
    struct stat status;
    weft_code code;
    if (fstat(descriptor, &status) != 0)
        code = weft_fail_errno(error, "read", path);
    else if (!S_ISREG(status.st_mode))
        code = weft_fail(error, WEFT_BAD_INPUT, "cannot read '%s': not a regular file", path);
    else if ((size_t)status.st_size > limit)
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s' has %lld bytes; at most %zu are read", path,
                         (long long)status.st_size, limit);
    else {
        *size = (size_t)status.st_size;
        code = read_descriptor(descriptor, path, *size, bytes, error);
    }
    close(descriptor);
    return code;
}

uint64_t weft_file_bytes(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 ? (uint64_t)status.st_size : 0;
}

bool weft_is_same_file(const char *a, const char *b)
{
    struct stat one, other;
    return stat(a, &one) == 0 && stat(b, &other) == 0 && one.st_dev == other.st_dev && one.st_ino == other.st_ino;
}

weft_code weft_output_folder_check(const char *path, weft_error *error)
{
    struct stat status;
    char there[PATH_MAX];
    if (!path[0] || strlen(path) >= sizeof there)
        return weft_fail(error, WEFT_BAD_USAGE, "not a folder name: '%.60s'", path);
    snprintf(there, sizeof there, "%s", path);
    while (stat(there, &status) != 0) {
        if ((errno != ENOENT && errno != ENOTDIR) || strcmp(there, ".") == 0)
            return weft_fail_errno(error, "create folder", path);
        folder_of(there, there);
    }
    if (!S_ISDIR(status.st_mode))
        return weft_fail(error, WEFT_SYSTEM, "cannot create folder '%s': '%s' is a file", path, there);
    return try_folder(there, error);
}

weft_code weft_make_folder(const char *path, weft_error *error)
{
    char partial[PATH_MAX];
    if (!path[0] || strlen(path) >= sizeof partial)
        return weft_fail(error, WEFT_BAD_USAGE, "not a folder name: '%.60s'", path);
    for (const char *end = path + 1;; end++) {
        if (*end != '/' && *end != '\0')
            continue;
        snprintf(partial, sizeof partial, "%.*s", (int)(end - path), path);
        if (mkdir(partial, 0777) != 0 && errno != EEXIST)
            return weft_fail_errno(error, "create folder", partial);
        if (*end == '\0')
            break;
    }
    struct stat status;
    if (stat(path, &status) != 0 || !S_ISDIR(status.st_mode))
        return weft_fail(error, WEFT_SYSTEM, "cannot create folder '%s': a file of that name exists", path);
    return WEFT_OK;
}
