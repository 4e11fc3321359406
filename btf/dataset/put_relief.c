#include "base/atomic_file.h"
#include "base/text/json_text.h"
#include "btf/dataset/create.h"

#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <stdlib.h>
#include <unistd.h>

/* Without room for the whole copy nothing is begun: HDF5 1.10 crashes at exit where it could not write a file. */
static int copy_bytes(int from, int to)
{
    off_t size = lseek(from, 0, SEEK_END);
    if (size < 0 || lseek(from, 0, SEEK_SET) < 0)
        return -1;
    int failure = posix_fallocate(to, 0, size);
    if (failure != 0) {
        errno = failure;
        return -1;
    }
    for (off_t left = size; left > 0;) {
        ssize_t copied = copy_file_range(from, NULL, to, NULL, (size_t)left, 0);
        if (copied <= 0)
            return -1;
        left -= copied;
    }
    return 0;
}

static weft_code copy_file(const char *path, const char *copy, const char *output, weft_error *error)
{
    int from = open(path, O_RDONLY | O_CLOEXEC);
    if (from < 0)
        return weft_fail_errno(error, "open", path);
    int to = open(copy, O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    int result = to < 0 ? -1 : copy_bytes(from, to), saved = errno;
    close(from);
    if (to >= 0 && close(to) != 0 && result == 0) {
        result = -1;
        saved = errno;
    }
    errno = saved;
    return result == 0 ? WEFT_OK : weft_fail_errno(error, "write", output);
}

/* What the readers of `path` would say of these heights; and its provenance with `made` in it. */
static weft_code check(const char *path, double plane_mm, const weft_dataset_heights *heights, const char *made,
                       char **provenance, weft_error *error)
{
    weft_dataset *dataset;
    WEFT_TRY(weft_dataset_open(path, &dataset, error));
    weft_dataset_layout layout = *weft_dataset_get_layout(dataset);
    layout.plane_mm = plane_mm;
    weft_code code = weft_dataset_layout_check(&layout, path, WEFT_BAD_INPUT, error);
    if (code == WEFT_OK && heights)
        code = weft_dataset_heights_check(&layout, heights, path, WEFT_BAD_INPUT, error);
    if (code == WEFT_OK) {
        *provenance = weft_json_with_member(layout.provenance, "relief", json_loads(made, 0, NULL), JSON_COMPACT);
        code = *provenance ? WEFT_OK : weft_fail_memory(error, "provenance", 0);
    }
    weft_dataset_close(dataset);
    return code;
}

static weft_code change(const char *copy, const char *output, double plane_mm, const weft_dataset_heights *heights,
                        const char *provenance, weft_error *error)
{
    weft_dataset_file file;
    WEFT_TRY(weft_dataset_file_open(copy, output, &file, error));
    weft_code code = weft_dataset_file_write_relief(&file, plane_mm, heights, error);
    if (code == WEFT_OK)
        code = weft_dataset_file_write_provenance(&file, provenance, error);
    weft_code closed = weft_dataset_file_close(&file, code == WEFT_OK ? error : NULL);
    return code == WEFT_OK ? closed : code;
}

static weft_code put(const char *path, const char *output, double plane_mm, const weft_dataset_heights *heights,
                     const char *provenance, weft_error *error)
{
    weft_atomic_file atomic;
    WEFT_TRY(weft_atomic_file_begin(output, &atomic, error));
    weft_code code = copy_file(path, atomic.temporary_path, output, error);
    if (code == WEFT_OK)
        code = change(atomic.temporary_path, output, plane_mm, heights, provenance, error);
    if (code == WEFT_OK)
        return weft_atomic_file_commit(&atomic, error);
    weft_atomic_file_abandon(&atomic);
    return code;
}

weft_code weft_dataset_put_relief(const char *path, const char *output, double plane_mm,
                                  const weft_dataset_heights *heights, const char *made, weft_error *error)
{
    char *provenance = NULL;
    WEFT_TRY(check(path, plane_mm, heights, made, &provenance, error));
    weft_code code = put(path, output, plane_mm, heights, provenance, error);
    free(provenance);
    return code;
}
