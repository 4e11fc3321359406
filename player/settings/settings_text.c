#include "player/settings/settings.h"

#include "base/text/json_text.h"
#include "player/scene/surroundings.h"
#include "player/settings/json.h"
#include "player/settings/relative_path.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VERSION = 1 };

/* ---- Names of files ---- */

enum { FILE_COUNT = 5 };

static void list_files(weft_settings *settings, char **name[FILE_COUNT])
{
    name[0] = &settings->material;
    name[1] = &settings->dataset;
    name[2] = &settings->weave;
    name[3] = &settings->environment;
    name[4] = &settings->mesh;
}

typedef bool built_in(const char *name);

static bool none_built_in(const char *name)
{
    (void)name;
    return false;
}

static built_in *built_in_of(char *const *name, const weft_settings *settings)
{
    return name == &settings->mesh          ? weft_mesh_is_built_in
           : name == &settings->environment ? weft_surroundings_are
                                            : none_built_in;
}

/* The result is owned. A file that is called as something built in is kept apart from it by its folder. */
static weft_code name_beside(const char *path, built_in *is_built_in, const char *beside, char **name,
                             weft_error *error)
{
    if (is_built_in(path)) {
        *name = strdup(path);
        return *name ? WEFT_OK : weft_fail_memory(error, path, strlen(path));
    }
    WEFT_TRY(weft_path_relative_to(path, beside, name, error));
    if (!is_built_in(*name))
        return WEFT_OK;
    char *dotted = NULL;
    int length = asprintf(&dotted, "./%s", *name);
    free(*name);
    *name = length < 0 ? NULL : dotted;
    return *name ? WEFT_OK : weft_fail_memory(error, path, strlen(path));
}

/* ---- Text ---- */

static weft_code write_text(const weft_settings *settings, char **text, weft_error *error)
{
    json_t *object = json_pack("{si}", "version", VERSION);
    if (!object)
        return weft_fail_memory(error, "settings", 0);
    weft_code code = weft_settings_write_json(weft_settings_schema(), settings, object, error);
    if (code == WEFT_OK) {
        *text = json_dumps(object, JSON_INDENT(1) | JSON_ENSURE_ASCII);
        code = *text ? WEFT_OK : weft_fail_memory(error, "settings", 0);
    }
    json_decref(object);
    return code;
}

weft_code weft_settings_format(const weft_settings *settings, const char *beside, char **text, weft_error *error)
{
    weft_settings named = *settings;
    char **name[FILE_COUNT], *owned[FILE_COUNT] = {0};
    weft_code code = WEFT_OK;
    list_files(&named, name);
    for (int i = 0; i < FILE_COUNT; i++) {
        if (*name[i] && code == WEFT_OK)
            code = name_beside(*name[i], built_in_of(name[i], &named), beside, &owned[i], error);
        *name[i] = owned[i];
    }
    if (code == WEFT_OK)
        code = write_text(&named, text, error);
    for (int i = 0; i < FILE_COUNT; i++)
        free(owned[i]);
    return code;
}

static weft_code check_light(const weft_settings *s, const char *where, weft_error *error)
{
    if (s->scene.light_count == 0 && !s->scene.environment)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: neither 'light.lights' nor 'light.environment' gives light",
                         where);
    if (s->scene.environment && !s->environment)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: 'light.environment' needs 'files.environment'", where);
    return WEFT_OK;
}

static weft_code find_files(weft_settings *settings, const char *source, weft_error *error)
{
    char **name[FILE_COUNT];
    list_files(settings, name);
    for (int i = 0; i < FILE_COUNT; i++) {
        if (!*name[i] || built_in_of(name[i], settings)(*name[i]))
            continue;
        char *found = weft_path_beside(*name[i], source);
        if (!found)
            return weft_fail_memory(error, source, strlen(source));
        free(*name[i]);
        *name[i] = found;
    }
    return WEFT_OK;
}

/* Takes the version out of the object; none stands for the only one there is. */
static weft_code check_version(json_t *root, const char *where, weft_error *error)
{
    const json_t *version = json_object_get(root, "version");
    if (version && (!json_is_integer(version) || json_integer_value(version) != VERSION))
        return weft_fail(error, WEFT_BAD_INPUT, "%s: 'version' must be a whole number from %d to %d", where, VERSION,
                         VERSION);
    json_object_del(root, "version");
    return WEFT_OK;
}

static weft_code read_settings(json_t *root, const char *source, weft_settings *settings, weft_error *error)
{
    char where[WEFT_MESSAGE_SIZE / 2];
    snprintf(where, sizeof where, "the settings in '%s'", source);
    WEFT_TRY(weft_settings_init(settings, error));
    WEFT_TRY(check_version(root, where, error));
    WEFT_TRY(weft_settings_read_json(weft_settings_schema(), root, where, settings, error));
    if (!settings->mesh)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: 'files.mesh' must not be null", where);
    WEFT_TRY(check_light(settings, where, error));
    return find_files(settings, source, error);
}

weft_code weft_settings_parse(const char *text, size_t size, const char *source, weft_settings *settings,
                              weft_error *error)
{
    json_error_t at;
    *settings = (weft_settings){0};
    errno = 0;
    json_t *root = json_loadb(text, size, JSON_REJECT_DUPLICATES, &at);
    if (!root)
        return weft_json_fail(error, WEFT_BAD_INPUT, "the settings in '%s': line %d, column %d: %s", source, at.line,
                              at.column, at.text);
    weft_code code = read_settings(root, source, settings, error);
    json_decref(root);
    if (code != WEFT_OK)
        weft_settings_free(settings);
    return code;
}
