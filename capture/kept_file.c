#include "capture/kept_file.h"

#include "base/atomic_file.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static weft_code copy_file(const char *from, const char *to, weft_error *error)
{
    const size_t limit = (size_t)1 << 31;
    char *bytes;
    size_t size;
    weft_sweep_left_over(to);
    WEFT_TRY(weft_read_file(from, limit, &bytes, &size, error));
    weft_code code = weft_write_file(to, bytes, size, error);
    free(bytes);
    if (code == WEFT_OK && remove(from) != 0)
        return weft_fail_errno(error, "remove", from);
    return code;
}

weft_code weft_keep_file(const char *from, const char *to, weft_error *error)
{
    char folder[PATH_MAX];
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(to, '/') - to), to);
    WEFT_TRY(weft_make_folder(folder, error));
    if (rename(from, to) == 0)
        return weft_sync_file(to, error);
    return errno == EXDEV ? copy_file(from, to, error) : weft_fail_errno(error, "keep", from);
}
