#include "player/settings/json.h"

#include "base/text/json_text.h"
#include "btf/direction/direction.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_SIZE = 160 };

static size_t element_size(const weft_setting *setting)
{
    switch (setting->option.kind) {
    case WEFT_OPTION_SWITCH:
        return sizeof(bool);
    case WEFT_OPTION_CHOICE:
        return sizeof(int);
    default:
        return sizeof(double);
    }
}

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

static json_t *text_of(const char *text)
{
    return text ? weft_json_text(text, strlen(text)) : json_null();
}

static json_t *element_of(const weft_option *option, const void *at)
{
    switch (option->kind) {
    case WEFT_OPTION_SWITCH:
        return json_boolean(*(const bool *)at);
    case WEFT_OPTION_WHOLE:
    case WEFT_OPTION_NOISE:
        return json_integer(*(const int *)at);
    case WEFT_OPTION_ANGLE:
        return json_real(degrees_of(*(const double *)at));
    case WEFT_OPTION_CHOICE:
        return json_string(option->words[*(const int *)at]);
    case WEFT_OPTION_NAME:
        return text_of(*(char *const *)at);
    default:
        return json_real(*(const double *)at);
    }
}

/* NULL also where an element is. */
static json_t *object_of(const weft_setting *table, const void *structure)
{
    weft_error ignored;
    json_t *object = json_object();
    if (object && weft_settings_write_json(table, structure, object, &ignored) == WEFT_OK)
        return object;
    json_decref(object);
    return NULL;
}

static json_t *value_of(const weft_setting *setting, const char *structure)
{
    const char *at = structure + setting->option.offset;
    int count = setting->count;
    if (setting->part)
        memcpy(&count, structure + setting->count_offset, sizeof count);
    else if (count == 0)
        return element_of(&setting->option, at);
    json_t *list = json_array();
    for (int i = 0; list && i < count; i++) {
        json_t *element = setting->part ? object_of(setting->part, at + (size_t)i * setting->stride)
                                        : element_of(&setting->option, at + (size_t)i * element_size(setting));
        weft_json_append(&list, element);
    }
    return list;
}

/* Puts the value into the objects that the key names, which are made where they are not there. */
static int set_by_key(json_t *object, const char *key, json_t *value)
{
    const char *dot;
    for (; (dot = strchr(key, '.')); key = dot + 1) {
        char name[PATH_SIZE];
        snprintf(name, sizeof name, "%.*s", (int)(dot - key), key);
        json_t *inner = json_object_get(object, name);
        if (!inner && json_object_set_new(object, name, inner = json_object()) != 0) {
            json_decref(value);
            return -1;
        }
        object = inner;
    }
    return json_object_set_new(object, key, value);
}

weft_code weft_settings_write_json(const weft_setting *table, const void *structure, json_t *object, weft_error *error)
{
    errno = 0;
    for (const weft_setting *setting = table; setting->key || setting->option.name; setting++)
        if (setting->key && set_by_key(object, setting->key, value_of(setting, structure)) != 0)
            return weft_json_fail(error, WEFT_BAD_USAGE, "a value cannot be written as JSON: a number is not finite");
    return WEFT_OK;
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

static weft_code refuse_range(reader *r, double low, double high, const char *what)
{
    char wanted[96];
    snprintf(wanted, sizeof wanted, "%s from %g to %g", what, low, high);
    return refuse(r, wanted);
}

static weft_code read_number(reader *r, const weft_option *option, const json_t *value, double *number)
{
    bool is_angle = option->kind == WEFT_OPTION_ANGLE;
    double given = json_number_value(value);
    if (!json_is_number(value) || !(given >= option->low && given <= option->high))
        return refuse_range(r, option->low, option->high, is_angle ? "an angle in degrees" : "a number");
    *number = is_angle ? weft_rad_of_deg(given) : given;
    return WEFT_OK;
}

static weft_code read_whole(reader *r, double low, double high, const json_t *value, int *number)
{
    json_int_t given = json_integer_value(value);
    if (!json_is_integer(value) || (double)given < low || (double)given > high)
        return refuse_range(r, low, high, "a whole number");
    *number = (int)given;
    return WEFT_OK;
}

static weft_code read_choice(reader *r, const weft_option *option, const json_t *value, int *choice)
{
    char wanted[128] = "";
    for (int i = 0; option->words[i]; i++) {
        if (json_is_string(value) && strcmp(json_string_value(value), option->words[i]) == 0) {
            *choice = i;
            return WEFT_OK;
        }
        size_t used = strlen(wanted);
        snprintf(wanted + used, sizeof wanted - used, "%s\"%s\"", i > 0 ? ", " : "one of ", option->words[i]);
    }
    return refuse(r, wanted);
}

static weft_code read_switch(reader *r, const json_t *value, bool *given)
{
    if (!json_is_boolean(value))
        return refuse(r, "true or false");
    *given = json_is_true(value);
    return WEFT_OK;
}

static weft_code read_name(reader *r, const json_t *value, char **name)
{
    if (!json_is_string(value) && !json_is_null(value))
        return refuse(r, "a string or null");
    return weft_option_copy(json_string_value(value), name, r->error);
}

static weft_code read_element(reader *r, const weft_option *option, const json_t *value, void *at)
{
    switch (option->kind) {
    case WEFT_OPTION_SWITCH:
        return read_switch(r, value, at);
    case WEFT_OPTION_WHOLE:
        return read_whole(r, option->low, option->high, value, at);
    case WEFT_OPTION_NOISE:
        return read_whole(r, 0, INT_MAX, value, at);
    case WEFT_OPTION_CHOICE:
        return read_choice(r, option, value, at);
    case WEFT_OPTION_NAME:
        return read_name(r, value, at);
    default:
        return read_number(r, option, value, at);
    }
}

static weft_code read_object(reader *r, const weft_setting *table, const char *prefix, const json_t *object,
                             char *structure);

static weft_code read_list(reader *r, const weft_setting *setting, const json_t *value, char *structure)
{
    int least = setting->part ? 0 : setting->count, most = setting->part ? setting->most : setting->count;
    int count = json_is_array(value) && json_array_size(value) <= (size_t)most ? (int)json_array_size(value) : -1;
    if (count < least) {
        char wanted[96];
        snprintf(wanted, sizeof wanted, "a list of %d to %d", least, most);
        return refuse(r, wanted);
    }
    char *at = structure + setting->option.offset;
    size_t length = strlen(r->path);
    for (int i = 0; i < count; i++) {
        const json_t *element = json_array_get(value, (size_t)i);
        snprintf(r->path + length, sizeof r->path - length, "[%d]", i);
        if (setting->part)
            WEFT_TRY(read_object(r, setting->part, "", element, at + (size_t)i * setting->stride));
        else
            WEFT_TRY(read_element(r, &setting->option, element, at + (size_t)i * element_size(setting)));
    }
    r->path[length] = '\0';
    if (setting->part)
        memcpy(structure + setting->count_offset, &count, sizeof count);
    return WEFT_OK;
}

/* The setting that a key names, or the first in the object that it names. */
static const weft_setting *find_setting(const weft_setting *table, const char *key, bool *is_object)
{
    size_t length = strlen(key);
    for (; table->key || table->option.name; table++) {
        if (!table->key || strncmp(table->key, key, length) != 0)
            continue;
        *is_object = table->key[length] == '.';
        if (*is_object || table->key[length] == '\0')
            return table;
    }
    return NULL;
}

/* A dot parts names and is in none. */
static weft_code read_member(reader *r, const weft_setting *table, const char *prefix, const char *name,
                             const json_t *value, char *structure)
{
    char key[PATH_SIZE];
    bool is_object = false;
    snprintf(key, sizeof key, "%s%s%s", prefix, prefix[0] ? "." : "", name);
    const weft_setting *setting = strchr(name, '.') ? NULL : find_setting(table, key, &is_object);
    if (!setting)
        return weft_fail(r->error, WEFT_BAD_INPUT, "%s: '%s' is not known", r->where, r->path);
    if (is_object)
        return read_object(r, table, key, value, structure);
    if (setting->part || setting->count > 0)
        return read_list(r, setting, value, structure);
    return read_element(r, &setting->option, value, structure + setting->option.offset);
}

static weft_code read_object(reader *r, const weft_setting *table, const char *prefix, const json_t *object,
                             char *structure)
{
    if (!json_is_object(object))
        return refuse(r, "an object");
    size_t length = strlen(r->path);
    const char *name;
    json_t *value;
    json_object_foreach ((json_t *)object, name, value) {
        snprintf(r->path + length, sizeof r->path - length, "%s%s", length > 0 ? "." : "", name);
        WEFT_TRY(read_member(r, table, prefix, name, value, structure));
        r->path[length] = '\0';
    }
    return WEFT_OK;
}

weft_code weft_settings_read_json(const weft_setting *table, const json_t *object, const char *where, void *structure,
                                  weft_error *error)
{
    reader r = {.where = where, .error = error};
    if (!json_is_object(object))
        return weft_fail(error, WEFT_BAD_INPUT, "%s: not a JSON object", where);
    return read_object(&r, table, "", object, structure);
}
