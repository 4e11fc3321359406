#include "base/text/text_file.h"
#include "reflectance/weave/syntax.h"

#include <stdlib.h>
#include <string.h>

weft_code weft_weave_parse(const char *text, const char *path, const weft_parameter *parameters, int parameter_count,
                           weft_weave *weave, char warning[WEFT_MESSAGE_SIZE], weft_error *error)
{
    WEFT_TRY(weft_weave_parse_text(text, path, parameters, parameter_count, weave, error));
    weft_weave_derive(weave, path, warning);
    weave->specular_scale = weft_weave_specular_scale(weave);
    return WEFT_OK;
}

void weft_weave_update_yarns(weft_weave *weave)
{
    weft_weave_derive(weave, NULL, NULL);
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

weft_code weft_weave_read(const char *path, const weft_parameter *parameters, int parameter_count, weft_weave *weave,
                          char warning[WEFT_MESSAGE_SIZE], weft_error *error)
{
    *weave = (weft_weave){0};
    char *text;
    WEFT_TRY(weft_text_file_read(path, &text, error));
    weft_code code = weft_weave_parse(text, path, parameters, parameter_count, weave, warning, error);
    free(text);
    return code;
}
