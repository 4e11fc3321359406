#include "base/text/json_text.h"

#include "base/atomic_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

json_t *weft_json_text(const char *text, size_t length)
{
    errno = 0;
    json_t *string = json_stringn(text, length);
    if (string || errno == ENOMEM)
        return string;
    char *ascii = strndup(text, length);
    if (!ascii)
        return NULL;
    for (char *byte = ascii; *byte; byte++)
        *byte = (unsigned char)*byte < 0x80 ? *byte : '?';
    string = json_string(ascii);
    free(ascii);
    return string;
}

weft_code weft_json_parse(const char *text, size_t size, size_t flags, const char *path, json_t **root,
                          weft_error *error)
{
    json_error_t where;
    errno = 0;
    *root = json_loadb(text, size, flags, &where);
    if (*root)
        return WEFT_OK;
    return weft_json_fail(error, WEFT_BAD_INPUT, "'%s': line %d, column %d: %s", path, where.line, where.column,
                          where.text);
}

static void drop_incomplete(json_t **whole, int failure)
{
    if (failure == 0)
        return;
    json_decref(*whole);
    *whole = NULL;
}

void weft_json_put(json_t **object, const char *name, json_t *value)
{
    drop_incomplete(object, json_object_set_new(*object, name, value));
}

void weft_json_append(json_t **list, json_t *value)
{
    drop_incomplete(list, json_array_append_new(*list, value));
}

json_t *weft_json_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

weft_code weft_json_read(const char *path, size_t limit, json_t **root, weft_error *error)
{
    char *text = NULL;
    size_t size;
    WEFT_TRY(weft_read_file(path, limit, &text, &size, error));
    weft_code code = weft_json_parse(text, size, JSON_REJECT_DUPLICATES, path, root, error);
    free(text);
    return code;
}

static weft_code check_kind(const json_t *root, const char *path, const weft_json_kind *kind, weft_error *error)
{
    const json_t *version = json_object_get(root, kind->member);
    if (!json_is_integer(version))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' %s", path, kind->is_none);
    if (json_integer_value(version) != kind->version)
        return weft_fail(error, WEFT_NOT_SUPPORTED, "'%s' %s of version %lld, this program reads version %d", path,
                         kind->is_one, (long long)json_integer_value(version), kind->version);
    return WEFT_OK;
}

weft_code weft_json_read_kind(const char *path, size_t limit, const weft_json_kind *kind, json_t **root,
                              weft_error *error)
{
    WEFT_TRY(weft_json_read(path, limit, root, error));
    weft_code code = check_kind(*root, path, kind, error);
    if (code != WEFT_OK)
        json_decref(*root);
    return code;
}

weft_code weft_json_write(const char *path, json_t *root, size_t flags, weft_error *error)
{
    char *text = root ? json_dumps(root, flags) : NULL;
    json_decref(root);
    if (!text)
        return weft_fail_memory(error, path, 0);
    weft_code code = weft_write_file(path, text, strlen(text), error);
    free(text);
    return code;
}

char *weft_json_with_member(const char *object, const char *name, json_t *value, size_t flags)
{
    json_t *root = json_loads(object, 0, NULL);
    if (root)
        weft_json_put(&root, name, value);
    else
        json_decref(value);
    char *text = root ? json_dumps(root, flags) : NULL;
    json_decref(root);
    return text;
}
