#include "reflectance/weave_syntax.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

weft_code weft_weave_parse(const char *text, const char *path, const weft_weave_parameter *parameters,
                           int parameter_count, weft_weave *weave, char warning[WEFT_MESSAGE_SIZE], weft_error *error)
{
    WEFT_TRY(weave_parse_text(text, path, parameters, parameter_count, weave, error));
    weave_derive(weave, path, warning);
    weave->specular_scale = weft_weave_specular_scale(weave);
    return WEFT_OK;
}

void weft_weave_update_yarns(weft_weave *weave)
{
    weave_derive(weave, NULL, NULL);
}

void weft_weave_update(weft_weave *weave)
{
    weft_weave_update_yarns(weave);
    weave->specular_scale = weft_weave_specular_scale(weave);
}

weft_code weft_weave_copy(const weft_weave *from, weft_weave *to, weft_error *error)
{
    size_t cells = (size_t)from->tile_width * (size_t)from->tile_height, yarns = (size_t)from->yarn_count;
    *to = *from;
    to->pattern = malloc(cells * sizeof *to->pattern);
    to->yarn = malloc(yarns * sizeof *to->yarn);
    if (!to->pattern || !to->yarn) {
        weft_weave_free(to);
        return weft_fail_memory(error, "weave", cells * sizeof *to->pattern + yarns * sizeof *to->yarn);
    }
    memcpy(to->pattern, from->pattern, cells * sizeof *to->pattern);
    memcpy(to->yarn, from->yarn, yarns * sizeof *to->yarn);
    return WEFT_OK;
}

/* Reads to the end rather than by a size asked beforehand, so that pipes work too. */
static weft_code read_stream(FILE *file, const char *path, char *text, weft_error *error)
{
    size_t size = fread(text, 1, WEAVE_MAX_BYTES + 1, file);
    if (ferror(file))
        return weft_fail_errno(error, "read", path);
    if (size > WEAVE_MAX_BYTES)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: more than %d bytes, not a weave file", path, WEAVE_MAX_BYTES);
    text[size] = '\0';
    if (strlen(text) != size)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: byte %zu is 0, not a text file", path, strlen(text));
    return WEFT_OK;
}

weft_code weave_read_text(const char *path, char **result, weft_error *error)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return weft_fail(error, errno == ENOMEM ? WEFT_SYSTEM : WEFT_BAD_INPUT, "cannot read '%s': %s", path,
                         strerror(errno));
    char *text = malloc(WEAVE_MAX_BYTES + 2);
    weft_code code = text ? read_stream(file, path, text, error) : weft_fail_memory(error, path, WEAVE_MAX_BYTES + 2);
    fclose(file);
    if (code == WEFT_OK)
        *result = text;
    else
        free(text);
    return code;
}

weft_code weft_weave_read(const char *path, const weft_weave_parameter *parameters, int parameter_count,
                          weft_weave *weave, char warning[WEFT_MESSAGE_SIZE], weft_error *error)
{
    *weave = (weft_weave){0};
    char *text;
    WEFT_TRY(weave_read_text(path, &text, error));
    weft_code code = weft_weave_parse(text, path, parameters, parameter_count, weave, warning, error);
    free(text);
    return code;
}
