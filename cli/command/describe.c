#include "cli/command/describe.h"

#include <stdlib.h>
#include <string.h>

enum { LINE_SIZE = 1024 };

/* One value on one line: numbers short, strings bare. False where memory is short. */
static bool format_value(const json_t *value, char *text, size_t size)
{
    char *dumped = NULL;
    if (json_is_real(value))
        snprintf(text, size, "%.6g", json_real_value(value));
    else if (json_is_string(value))
        snprintf(text, size, "%s", json_string_value(value));
    else if (json_is_array(value) && json_array_size(value) == 2 && json_is_integer(json_array_get(value, 0)))
        snprintf(text, size, "%lld x %lld", json_integer_value(json_array_get(value, 0)),
                 json_integer_value(json_array_get(value, 1)));
    else if ((dumped = json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(6))))
        snprintf(text, size, "%s", dumped);
    else
        return false;
    free(dumped);
    return true;
}

static bool is_list_of_objects(const json_t *value)
{
    return json_is_array(value) && json_is_object(json_array_get(value, 0));
}

static bool say_object(const weft_common_options *common, json_t *object, int indent);

static bool say_member(const weft_common_options *common, const char *name, json_t *value, int indent)
{
    if (json_is_object(value)) {
        weft_command_say(common, "%*s%s:", indent, "", name);
        return say_object(common, value, indent + 2);
    }
    if (is_list_of_objects(value)) {
        for (size_t i = 0; i < json_array_size(value); i++) {
            weft_command_say(common, "%*s%s %zu:", indent, "", name, i);
            if (!say_object(common, json_array_get(value, i), indent + 2))
                return false;
        }
        return true;
    }
    char text[LINE_SIZE];
    if (!format_value(value, text, sizeof text))
        return false;
    weft_command_say(common, "%*s%s: %s", indent, "", name, text);
    return true;
}

static bool say_object(const weft_common_options *common, json_t *object, int indent)
{
    const char *name;
    json_t *value;
    json_object_foreach (object, name, value) {
        if (!say_member(common, name, value, indent))
            return false;
    }
    return true;
}

static bool say_event(const weft_common_options *common, const char *event, json_t *object)
{
    json_t *whole = json_pack("{s:s}", "event", event);
    char *line = json_object_update(whole, object) == 0 ? json_dumps(whole, JSON_COMPACT) : NULL;
    bool is_complete = line != NULL;
    if (is_complete)
        weft_command_event(common, line);
    free(line);
    json_decref(whole);
    return is_complete;
}

weft_code weft_command_describe(const weft_common_options *common, const char *event, json_t *object, weft_error *error)
{
    bool said = common->json ? say_event(common, event, object) : say_object(common, object, 0);
    return said ? WEFT_OK : weft_fail_memory(error, "description", 0);
}

weft_code weft_command_report(const weft_common_options *common, const char *event, json_t *object, weft_error *error)
{
    bool said = object && (!common->json || say_event(common, event, object));
    json_decref(object);
    return said ? WEFT_OK : weft_fail_memory(error, "event", 0);
}
