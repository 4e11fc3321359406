#include "btf/session/camera_list.h"

#include "base/text/json_text.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LIST_VERSION = 1, MAX_LIST_BYTES = 1 << 16 };

const char weft_camera_list_file[] = "cameras.json";

bool weft_camera_name_is_sound(const char *name)
{
    static const char allowed[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
    size_t length = strlen(name);
    return length > 0 && length < WEFT_CAMERA_NAME_SIZE && strspn(name, allowed) == length;
}

/* ---- The file ---- */

static weft_code unpack_name(json_t *json, const char *path, weft_camera_list *list, weft_error *error)
{
    const char *name = json_string_value(json);
    if (!name || !weft_camera_name_is_sound(name))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': camera %d has no name that a folder could have", path,
                         list->count);
    for (int i = 0; i < list->count; i++) {
        if (strcasecmp(list->name[i], name) == 0)
            return weft_fail(error, WEFT_BAD_INPUT, "'%s' names the camera '%s' twice", path, name);
    }
    snprintf(list->name[list->count++], WEFT_CAMERA_NAME_SIZE, "%s", name);
    return WEFT_OK;
}

static weft_code unpack(json_t *root, const char *path, weft_camera_list *list, weft_error *error)
{
    json_int_t version = 0;
    json_t *names = json_object_get(root, "cameras");
    size_t count = json_array_size(names);
    if (json_unpack(root, "{sI}", "weft_cameras", &version) != 0 || version != LIST_VERSION)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is no list of cameras of version %d", path, LIST_VERSION);
    if (!json_is_array(names))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has no array 'cameras'", path);
    if (count < 1 || count > WEFT_CAMERAS_MAX)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' names %zu cameras, not 1 to %d", path, count, WEFT_CAMERAS_MAX);
    for (size_t i = 0; i < count; i++)
        WEFT_TRY(unpack_name(json_array_get(names, i), path, list, error));
    return WEFT_OK;
}

weft_code weft_camera_list_read(const char *folder, weft_camera_list *list, weft_error *error)
{
    char path[PATH_MAX];
    json_t *root = NULL;
    *list = (weft_camera_list){0};
    snprintf(path, sizeof path, "%s/%s", folder, weft_camera_list_file);
    if (access(path, F_OK) != 0)
        return WEFT_OK;
    WEFT_TRY(weft_json_read(path, MAX_LIST_BYTES, &root, error));
    weft_code code = unpack(root, path, list, error);
    json_decref(root);
    return code;
}

weft_code weft_camera_list_write(const char *folder, const weft_camera_list *list, weft_error *error)
{
    char path[PATH_MAX];
    json_t *names = json_array();
    snprintf(path, sizeof path, "%s/%s", folder, weft_camera_list_file);
    for (int i = 0; i < list->count; i++)
        weft_json_append(&names, json_string(list->name[i]));
    json_t *root = json_pack("{si so}", "weft_cameras", LIST_VERSION, "cameras", names);
    return weft_json_write(path, root, JSON_INDENT(1), error);
}

weft_code weft_camera_file(const char *path, const char *camera, char *file, size_t size, weft_error *error)
{
    struct stat status;
    bool is_folder = stat(path, &status) == 0 && S_ISDIR(status.st_mode);
    if (camera && !is_folder)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' must be a folder with one file for each camera, such as '%s.json'", path, camera);
    if (!camera && is_folder)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is a folder; there is one camera, so name its file", path);
    snprintf(file, size, "%s%s%s%s", path, camera ? "/" : "", camera ? camera : "", camera ? ".json" : "");
    return WEFT_OK;
}

/* ---- The sessions ---- */

weft_code weft_camera_session_open(const char *folder, weft_session *session, weft_error *error)
{
    weft_camera_list list;
    WEFT_TRY(weft_camera_list_read(folder, &list, error));
    if (list.count > 0)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' holds several cameras; name one of them, such as '%s/%s'", folder,
                         folder, list.name[0]);
    return weft_session_open(folder, session, error);
}

static weft_code open_all(const char *folder, const weft_camera_list *list, weft_session *sessions, int *count,
                          weft_error *error)
{
    if (list->count == 0) {
        WEFT_TRY(weft_session_open(folder, &sessions[0], error));
        *count = 1;
    }
    for (int i = 0; i < list->count; i++) {
        char path[PATH_MAX];
        snprintf(path, sizeof path, "%s/%s", folder, list->name[i]);
        WEFT_TRY(weft_session_open(path, &sessions[i], error));
        *count = i + 1;
    }
    return WEFT_OK;
}

weft_code weft_camera_sessions_open(const char *folder, weft_session **sessions, int *count, weft_error *error)
{
    weft_camera_list list;
    WEFT_TRY(weft_camera_list_read(folder, &list, error));
    *count = 0;
    *sessions = calloc(WEFT_CAMERAS_MAX, sizeof **sessions);
    if (!*sessions)
        return weft_fail_memory(error, folder, WEFT_CAMERAS_MAX * sizeof **sessions);
    weft_code code = open_all(folder, &list, *sessions, count, error);
    if (code != WEFT_OK) {
        weft_camera_sessions_free(*sessions, *count);
        *sessions = NULL;
        *count = 0;
    }
    return code;
}

void weft_camera_sessions_free(weft_session *sessions, int count)
{
    for (int i = 0; i < count; i++)
        weft_session_free(&sessions[i]);
    free(sessions);
}

weft_code weft_camera_sessions_agree(const weft_session *sessions, int count, weft_error *error)
{
    for (int i = 1; i < count; i++) {
        const weft_session *a = &sessions[0], *b = &sessions[i];
        bool both = a->colour.terms > 0 && b->colour.terms > 0, none = a->colour.terms == 0 && b->colour.terms == 0;
        bool one_model = a->camera_model && b->camera_model && strcmp(a->camera_model, b->camera_model) == 0;
        if (!both && !(none && one_model))
            return weft_fail(
                error, WEFT_BAD_INPUT,
                "'%s' and '%s' do not see the same colours: give each camera its colours (weft colour), or "
                "name one model for both",
                a->folder, b->folder);
    }
    return WEFT_OK;
}
