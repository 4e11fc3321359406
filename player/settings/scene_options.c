#include "player/settings/scene_options.h"

#include "btf/file_kind.h"
#include "player/scene/surroundings.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool is_material(const weft_setting *setting)
{
    return !setting->option.name;
}

weft_code weft_scene_request_add(weft_scene_request *r, const weft_setting *setting, const char *text,
                                 weft_error *error)
{
    if (r->option_count == WEFT_REQUEST_MAX_OPTIONS)
        return weft_fail(error, WEFT_BAD_USAGE, "more than %d options", WEFT_REQUEST_MAX_OPTIONS);
    for (int i = 0; i < r->option_count; i++)
        if (is_material(setting) && is_material(r->option[i].setting))
            return weft_fail(error, WEFT_BAD_USAGE, "one material at a time: '%s' is one too many", text);
    r->option[r->option_count].setting = setting;
    r->option[r->option_count++].text = text;
    return WEFT_OK;
}

bool weft_scene_request_has(const weft_scene_request *r, const char *name)
{
    for (int i = 0; i < r->option_count; i++) {
        const char *given = r->option[i].setting->option.name;
        if (given && strcmp(given, name) == 0)
            return true;
    }
    return false;
}

/* Files that are named again need not be where the picture says. */
static void forget_files(weft_scene_request *r)
{
    for (int i = 0; i < r->option_count; i++) {
        const weft_option *option = &r->option[i].setting->option;
        char **name = (char **)((char *)&r->settings + option->offset);
        if (option->kind != WEFT_OPTION_NAME)
            continue;
        free(*name);
        *name = NULL;
    }
}

static weft_code start(weft_scene_request *r, weft_error *error)
{
    for (int i = 0; i < r->option_count; i++)
        if (r->option[i].setting->option.kind == WEFT_OPTION_TEXT)
            r->source = r->option[i].text;
    if (!r->source)
        return weft_settings_init(&r->settings, error);
    WEFT_TRY(weft_settings_read(r->source, &r->settings, error));
    forget_files(r);
    return weft_settings_check_files(&r->settings, r->source, error);
}

/* Before any work is done, and before a window opens. */
static weft_code check_files(const weft_settings *s, weft_error *error)
{
    bool is_map = s->environment && !weft_surroundings_are(s->environment);
    const char *const file[] = {s->material, s->dataset, s->weave, is_map ? s->environment : NULL};
    for (size_t i = 0; i < sizeof file / sizeof file[0]; i++)
        if (file[i] && access(file[i], F_OK) != 0)
            return weft_fail(error, WEFT_BAD_INPUT, "there is no file '%s'", file[i]);
    weft_file_kind kind;
    struct stat mesh;
    if (s->material && weft_file_is_bonn(s->material))
        return weft_file_kind_of(s->material, &kind, error); /* which says what to do with it */
    if (s->material && (weft_file_kind_of(s->material, &kind, NULL) != WEFT_OK || kind != WEFT_FILE_MATERIAL))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is no .weft file, dataset or cloth", s->material);
    if (!weft_mesh_is_built_in(s->mesh) && (stat(s->mesh, &mesh) != 0 || S_ISDIR(mesh.st_mode)))
        return weft_fail(error, WEFT_BAD_INPUT,
                         "there is no mesh '%s': --mesh takes drape, sphere, plane or an OBJ file", s->mesh);
    return WEFT_OK;
}

static weft_code check(const weft_scene_request *r, weft_error *error)
{
    const weft_settings *s = &r->settings;
    const char *const named[WEFT_MODE_COUNT] = {s->dataset, s->material, s->weave};
    static const char *const wanted[WEFT_MODE_COUNT] = {"--raw NAME.btf.h5", "NAME.weft", "--weave CLOTH.wv"};
    if (!s->material && !s->dataset && !s->weave)
        return weft_fail(error, WEFT_BAD_USAGE, "needs a material, a dataset with --raw, or a weave with --weave");
    for (int i = 0; r->has_modes && i < s->scene.pane_count; i++)
        if (!named[s->scene.pane[i]])
            return weft_fail(error, WEFT_BAD_USAGE, "--mode %s needs %s", weft_mode_name(s->scene.pane[i]),
                             wanted[s->scene.pane[i]]);
    if (s->scene.light_count == 0 && !s->scene.environment)
        return weft_fail(error, WEFT_BAD_USAGE, "--light none needs --environment");
    if (s->scene.environment && !s->environment)
        return weft_fail(error, WEFT_BAD_USAGE, "--environment-... needs --environment MAP.hdr");
    return check_files(s, error);
}

weft_code weft_scene_request_complete(weft_scene_request *r, weft_error *error)
{
    WEFT_TRY(start(r, error));
    for (int i = 0; i < r->option_count; i++)
        WEFT_TRY(weft_option_set(&r->option[i].setting->option, r->option[i].text, r, error));
    return check(r, error);
}

void weft_scene_request_free(weft_scene_request *r)
{
    weft_settings_free(&r->settings);
}

void weft_look(weft_scene_request *r, const char *surroundings)
{
    weft_scene *scene = &r->settings.scene;
    weft_surroundings_light(surroundings, scene);
    if (!weft_scene_request_has(r, "shadows"))
        scene->shadows = true;
    if (!weft_scene_request_has(r, "ground"))
        scene->ground = true;
    if (!weft_scene_request_has(r, "tone"))
        scene->tone = WEFT_TONE_SOFT;
}
