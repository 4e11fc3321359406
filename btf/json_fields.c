#include "btf/json_fields.h"

#include "btf/direction.h"
#include "btf/json_text.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_SIZE = 160 };

/* ---- Writing ---- */

/* The degrees that are read back as exactly these radians, where there are such. */
static double degrees_of(double angle_rad)
{
    double guess = weft_deg_of_rad(angle_rad);
    const double candidate[3] = {guess, nextafter(guess, INFINITY), nextafter(guess, -INFINITY)};
    for (int i = 0; i < 3; i++)
        if (weft_rad_of_deg(candidate[i]) == angle_rad)
            return candidate[i];
    return guess;
}

static json_t *value_of(const weft_json_field *field, const char *base);

static int list_count(const weft_json_field *field, const char *base)
{
    int count = field->most;
    if (field->least != field->most)
        memcpy(&count, base + field->count_offset, sizeof count);
    return count;
}

static json_t *list_of(const weft_json_field *field, const char *base)
{
    json_t *list = json_array();
    for (int i = 0; list && i < list_count(field, base); i++)
        weft_json_append(&list, value_of(field->part, base + field->offset + (size_t)i * field->stride));
    return list;
}

static json_t *object_of(const weft_json_field *table, const char *base)
{
    json_t *object = json_object();
    for (const weft_json_field *field = table; object && field->name; field++)
        weft_json_put(&object, field->name, value_of(field, base));
    return object;
}

static json_t *text_of(const char *text)
{
    return text ? weft_json_text(text, strlen(text)) : json_null();
}

static json_t *value_of(const weft_json_field *field, const char *base)
{
    const void *at = base + field->offset;
    switch (field->kind) {
    case WEFT_JSON_NUMBER:
        return json_real(*(const double *)at);
    case WEFT_JSON_ANGLE:
        return json_real(degrees_of(*(const double *)at));
    case WEFT_JSON_WHOLE:
        return json_integer(*(const int *)at);
    case WEFT_JSON_SWITCH:
        return json_boolean(*(const bool *)at);
    case WEFT_JSON_CHOICE:
        return json_string(field->choice[*(const int *)at]);
    case WEFT_JSON_TEXT:
        return text_of(*(char *const *)at);
    case WEFT_JSON_PART:
        return object_of(field->part, at);
    default:
        return list_of(field, base);
    }
}

weft_code weft_json_write_fields(const weft_json_field *table, const void *structure, json_t **object,
                                 weft_error *error)
{
    errno = 0;
    *object = object_of(table, structure);
    if (*object)
        return WEFT_OK;
    return weft_json_fail(error, WEFT_BAD_USAGE, "a value cannot be written as JSON: a number is not finite");
}

/* ---- Reading ---- */

/* Where the reader is: "lights[1].theta_deg" of what `where` names. */
typedef struct reader {
    const char *where;
    char path[PATH_SIZE];
    weft_error *error;
} reader;

static weft_code refuse(reader *r, const char *wanted)
{
    return weft_fail(r->error, WEFT_BAD_INPUT, "%s: '%s' must be %s", r->where, r->path, wanted);
}

static weft_code refuse_range(reader *r, const weft_json_field *field, const char *what)
{
    char wanted[96];
    snprintf(wanted, sizeof wanted, "%s from %g to %g", what, field->low, field->high);
    return refuse(r, wanted);
}

static weft_code read_number(reader *r, const weft_json_field *field, const json_t *value, double *number)
{
    double given = json_number_value(value);
    if (!json_is_number(value) || !(given >= field->low && given <= field->high))
        return refuse_range(r, field, field->kind == WEFT_JSON_ANGLE ? "an angle in degrees" : "a number");
    *number = field->kind == WEFT_JSON_ANGLE ? weft_rad_of_deg(given) : given;
    return WEFT_OK;
}

static weft_code read_whole(reader *r, const weft_json_field *field, const json_t *value, int *number)
{
    json_int_t given = json_integer_value(value);
    if (!json_is_integer(value) || (double)given < field->low || (double)given > field->high)
        return refuse_range(r, field, "a whole number");
    *number = (int)given;
    return WEFT_OK;
}

static weft_code read_choice(reader *r, const weft_json_field *field, const json_t *value, int *choice)
{
    char wanted[128] = "";
    for (int i = 0; field->choice[i]; i++) {
        if (json_is_string(value) && strcmp(json_string_value(value), field->choice[i]) == 0) {
            *choice = i;
            return WEFT_OK;
        }
        size_t used = strlen(wanted);
        snprintf(wanted + used, sizeof wanted - used, "%s\"%s\"", i > 0 ? ", " : "one of ", field->choice[i]);
    }
    return refuse(r, wanted);
}

static weft_code read_text(reader *r, const json_t *value, char **text)
{
    if (!json_is_string(value) && !json_is_null(value))
        return refuse(r, "a string or null");
    char *copy = json_is_string(value) ? strdup(json_string_value(value)) : NULL;
    if (json_is_string(value) && !copy)
        return weft_fail_memory(r->error, r->where, json_string_length(value));
    free(*text);
    *text = copy;
    return WEFT_OK;
}

static weft_code read_value(reader *r, const weft_json_field *field, const json_t *value, char *base);

static weft_code read_list(reader *r, const weft_json_field *field, const json_t *value, char *base)
{
    int count =
        json_is_array(value) && json_array_size(value) <= (size_t)field->most ? (int)json_array_size(value) : -1;
    if (count < field->least) {
        char wanted[96];
        snprintf(wanted, sizeof wanted, "a list of %d to %d", field->least, field->most);
        return refuse(r, wanted);
    }
    size_t length = strlen(r->path);
    for (int i = 0; i < count; i++) {
        snprintf(r->path + length, sizeof r->path - length, "[%d]", i);
        WEFT_TRY(read_value(r, field->part, json_array_get(value, (size_t)i),
                            base + field->offset + (size_t)i * field->stride));
    }
    r->path[length] = '\0';
    if (field->least != field->most)
        memcpy(base + field->count_offset, &count, sizeof count);
    return WEFT_OK;
}

static const weft_json_field *find_field(const weft_json_field *table, const char *name)
{
    while (table->name && strcmp(table->name, name) != 0)
        table++;
    return table->name ? table : NULL;
}

static weft_code read_object(reader *r, const weft_json_field *table, const json_t *object, char *base)
{
    if (!json_is_object(object))
        return refuse(r, "an object");
    size_t length = strlen(r->path);
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)object, key, value)
    {
        const weft_json_field *field = find_field(table, key);
        snprintf(r->path + length, sizeof r->path - length, "%s%s", length > 0 ? "." : "", key);
        if (!field)
            return weft_fail(r->error, WEFT_BAD_INPUT, "%s: '%s' is not known", r->where, r->path);
        WEFT_TRY(read_value(r, field, value, base));
        r->path[length] = '\0';
    }
    return WEFT_OK;
}

static weft_code read_value(reader *r, const weft_json_field *field, const json_t *value, char *base)
{
    void *at = base + field->offset;
    switch (field->kind) {
    case WEFT_JSON_NUMBER:
    case WEFT_JSON_ANGLE:
        return read_number(r, field, value, at);
    case WEFT_JSON_WHOLE:
        return read_whole(r, field, value, at);
    case WEFT_JSON_SWITCH:
        if (!json_is_boolean(value))
            return refuse(r, "true or false");
        *(bool *)at = json_is_true(value);
        return WEFT_OK;
    case WEFT_JSON_CHOICE:
        return read_choice(r, field, value, at);
    case WEFT_JSON_TEXT:
        return read_text(r, value, at);
    case WEFT_JSON_PART:
        return read_object(r, field->part, value, at);
    default:
        return read_list(r, field, value, base);
    }
}

weft_code weft_json_read_fields(const weft_json_field *table, const json_t *object, const char *where, void *structure,
                                weft_error *error)
{
    reader r = {.where = where, .error = error};
    if (!json_is_object(object))
        return weft_fail(error, WEFT_BAD_INPUT, "%s: not a JSON object", where);
    return read_object(&r, table, object, structure);
}
