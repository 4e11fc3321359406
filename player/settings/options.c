#include "btf/file_kind.h"
#include "player/scene/surroundings.h"
#include "player/settings/settings.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- Where the options start from ---- */

static weft_code refuse_second_material(const weft_given_option *option, int count, weft_error *error)
{
    bool is_there = false;
    for (int i = 0; i < count; i++) {
        bool is_material = !option[i].setting->option.name;
        if (is_there && is_material)
            return weft_fail(error, WEFT_BAD_USAGE, "one material at a time: unexpected argument '%s'", option[i].text);
        is_there |= is_material;
    }
    return WEFT_OK;
}

/* Files that are named again need not be where the picture says. */
static void forget_files(const weft_given_option *given, int count, weft_settings *s)
{
    for (int i = 0; i < count; i++) {
        const weft_option *option = &given[i].setting->option;
        char **name = (char **)((char *)s + option->offset);
        if (option->kind != WEFT_OPTION_NAME)
            continue;
        free(*name);
        *name = NULL;
    }
}

static weft_code start(const weft_given_option *option, int count, weft_settings *s, weft_error *error)
{
    const char *source = NULL;
    for (int i = 0; i < count; i++)
        if (option[i].setting->option.kind == WEFT_OPTION_TEXT)
            source = option[i].text;
    if (!source)
        return weft_settings_init(s, error);
    WEFT_TRY(weft_settings_read(source, s, error));
    s->source = source;
    forget_files(option, count, s);
    return weft_settings_check_files(s, source, error);
}

/* ---- What they come to ---- */

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

static weft_code check(const weft_settings *s, weft_error *error)
{
    const char *const named[WEFT_MODE_COUNT] = {s->dataset, s->material, s->weave};
    static const char *const wanted[WEFT_MODE_COUNT] = {"--raw NAME.btf.h5", "NAME.weft", "--weave CLOTH.wv"};
    if (!s->material && !s->dataset && !s->weave)
        return weft_fail(error, WEFT_BAD_USAGE, "needs a material, a dataset with --raw, or a weave with --weave");
    for (int i = 0; weft_settings_has(s, "mode") && i < s->scene.pane_count; i++)
        if (!named[s->scene.pane[i]])
            return weft_fail(error, WEFT_BAD_USAGE, "--mode %s needs %s", weft_mode_name(s->scene.pane[i]),
                             wanted[s->scene.pane[i]]);
    if (s->scene.light_count == 0 && !s->scene.environment)
        return weft_fail(error, WEFT_BAD_USAGE, "--light none needs --environment");
    if (s->scene.environment && !s->environment)
        return weft_fail(error, WEFT_BAD_USAGE, "--environment-... needs --environment MAP.hdr");
    return check_files(s, error);
}

weft_code weft_settings_of_options(const weft_given_option *option, int count, weft_settings *s, weft_error *error)
{
    const weft_setting *schema = weft_settings_schema();
    *s = (weft_settings){0};
    WEFT_TRY(refuse_second_material(option, count, error));
    WEFT_TRY(start(option, count, s, error));
    for (int i = 0; i < count; i++)
        s->given |= UINT64_C(1) << (option[i].setting - schema);
    for (int i = 0; i < count; i++)
        WEFT_TRY(weft_option_set(&option[i].setting->option, option[i].text, s, error));
    return check(s, error);
}
