#include "btf/atomic_file.h"
#include "geometry/stitch_syntax.h"

#include <stdlib.h>
#include <string.h>

enum { MAX_BYTES = 10 << 20 };

weft_code weft_stitch_parse(const char *text, const char *path, weft_stitch *stitch, weft_error *error)
{
    WEFT_TRY(stitch_parse_text(text, path, stitch, error));
    weft_code code = stitch_check(stitch, path, error);
    if (code != WEFT_OK)
        weft_stitch_free(stitch);
    return code;
}

weft_code weft_stitch_read(const char *path, weft_stitch *stitch, weft_error *error)
{
    char *text;
    size_t size;
    *stitch = (weft_stitch){0};
    WEFT_TRY(weft_read_file(path, MAX_BYTES, &text, &size, error));
    weft_code code;
    if (strlen(text) != size)
        code = weft_fail(error, WEFT_BAD_INPUT, "%s: byte %zu is 0, not a text file", path, strlen(text));
    else
        code = weft_stitch_parse(text, path, stitch, error);
    free(text);
    return code;
}
