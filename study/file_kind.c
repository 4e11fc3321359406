#include "study/file_kind.h"

#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>

static bool ends_with(const char *text, const char *ending)
{
    size_t length = strlen(text), tail = strlen(ending);
    return length >= tail && strcmp(text + length - tail, ending) == 0;
}

weft_code weft_file_kind_of(const char *path, weft_file_kind *kind, weft_error *error)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return weft_fail(error, WEFT_BAD_INPUT, "there is no file '%s'", path);
    if (S_ISDIR(status.st_mode))
        *kind = WEFT_FILE_SESSION;
    else if (ends_with(path, ".h5"))
        *kind = WEFT_FILE_DATASET;
    else if (ends_with(path, ".weft"))
        *kind = WEFT_FILE_MATERIAL;
    else if (ends_with(path, ".wv"))
        *kind = WEFT_FILE_WEAVE;
    else if (ends_with(path, ".mc"))
        *kind = WEFT_FILE_MICROCYLINDER;
    else if (ends_with(path, ".stitch"))
        *kind = WEFT_FILE_STITCH;
    else
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is none of .btf.h5, .weft, .wv, .mc, .stitch or a session folder",
                         path);
    return WEFT_OK;
}
