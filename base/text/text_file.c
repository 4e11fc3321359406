#include "base/text/text_file.h"
#include "base/atomic_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Reads to the end rather than by a size asked beforehand, so that pipes work too. */
static weft_code read_stream(FILE *file, const char *path, char *text, weft_error *error)
{
    size_t size = fread(text, 1, WEFT_TEXT_FILE_MAX_BYTES + 1, file);
    if (ferror(file))
        return weft_fail(error, errno == EISDIR ? WEFT_BAD_INPUT : WEFT_SYSTEM, "cannot read '%s': %s", path,
                         strerror(errno));
    if (size > WEFT_TEXT_FILE_MAX_BYTES)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: more than %d bytes, too long for a description of cloth", path,
                         WEFT_TEXT_FILE_MAX_BYTES);
    text[size] = '\0';
    if (strlen(text) != size)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: byte %zu is 0, not a text file", path, strlen(text));
    return WEFT_OK;
}

weft_code weft_text_file_read(const char *path, char **result, weft_error *error)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return weft_fail_reading(error, "read", path);
    char *text = malloc(WEFT_TEXT_FILE_MAX_BYTES + 2);
    weft_code code =
        text ? read_stream(file, path, text, error) : weft_fail_memory(error, path, WEFT_TEXT_FILE_MAX_BYTES + 2);
    fclose(file);
    if (code == WEFT_OK)
        *result = text;
    else
        free(text);
    return code;
}
