#include "base/text/json_text.h"

#include "base/atomic_file.h"

#include <stdlib.h>
#include <string.h>

json_t *weft_json_text(const char *text, size_t length)
{
    json_t *string = json_stringn(text, length);
    char *ascii = string ? NULL : strndup(text, length);
    if (!ascii)
        return string;
    for (char *byte = ascii; *byte; byte++)
        *byte = (unsigned char)*byte < 0x80 ? *byte : '?';
    string = json_string(ascii);
    free(ascii);
    return string;
}

weft_code weft_json_read(const char *path, size_t limit, json_t **root, weft_error *error)
{
    char *text = NULL;
    size_t size;
    WEFT_TRY(weft_read_file(path, limit, &text, &size, error));
    json_error_t where;
    *root = json_loadb(text, size, JSON_REJECT_DUPLICATES, &where);
    free(text);
    if (*root)
        return WEFT_OK;
    return weft_fail(error, WEFT_BAD_INPUT, "'%s': line %d, column %d: %s", path, where.line, where.column, where.text);
}
