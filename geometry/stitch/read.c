#include "base/text/text_file.h"
#include "geometry/stitch/syntax.h"

#include <stdlib.h>

weft_code weft_stitch_parse(const char *text, const char *path, weft_stitch *stitch, weft_error *error)
{
    WEFT_TRY(weft_stitch_parse_text(text, path, stitch, error));
    weft_code code = weft_stitch_check(stitch, path, error);
    if (code != WEFT_OK)
        weft_stitch_free(stitch);
    return code;
}

weft_code weft_stitch_read(const char *path, weft_stitch *stitch, weft_error *error)
{
    char *text;
    *stitch = (weft_stitch){0};
    WEFT_TRY(weft_text_file_read(path, &text, error));
    weft_code code = weft_stitch_parse(text, path, stitch, error);
    free(text);
    return code;
}
