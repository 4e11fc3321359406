#include "player/settings/settings.h"

#include "base/atomic_file.h"
#include "base/text/json_text.h"
#include "player/scene/surroundings.h"
#include "player/settings/json.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

enum { VERSION = 1 };

static const char description[] = "Weft: radiance = BRDF x pi x cosine x irradiance x exposure";
static const size_t largest_text = (size_t)1 << 20;

weft_code weft_settings_init(weft_settings *settings, weft_error *error)
{
    *settings = (weft_settings){
        .mesh = strdup("drape"),
        .real_size = true,
        .width = 960,
        .height = 540,
        .samples = 3,
        .scene = weft_scene_default(),
    };
    return settings->mesh ? WEFT_OK : weft_fail_memory(error, "settings", 0);
}

void weft_settings_free(weft_settings *settings)
{
    free(settings->material);
    free(settings->dataset);
    free(settings->weave);
    free(settings->environment);
    free(settings->mesh);
    *settings = (weft_settings){0};
}

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
    /* Pictures of before 0.2 also say in how many bits tables were shown. */
    json_object_del(json_object_get(root, "model"), "table_bits");
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

/* ---- Files ---- */

static bool has_extension(const char *path, const char *extension)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, extension) == 0;
}

weft_code weft_settings_read(const char *path, weft_settings *settings, weft_error *error)
{
    char *text = NULL;
    size_t size = 0;
    *settings = (weft_settings){0};
    if (has_extension(path, ".json")) {
        WEFT_TRY(weft_read_file(path, largest_text, &text, &size, error));
    } else {
        WEFT_TRY(weft_image_read_settings(path, &text, error));
        if (!text)
            return weft_fail(error, WEFT_BAD_INPUT, "'%s' carries no settings of Weft", path);
        size = strlen(text);
    }
    weft_code code = weft_settings_parse(text, size, path, settings, error);
    free(text);
    return code;
}

weft_code weft_settings_check_files(const weft_settings *s, const char *source, weft_error *error)
{
    static const char *const kind[] = {"material", "dataset", "weave", "environment", "mesh"};
    const char *const file[] = {s->material, s->dataset, s->weave,
                                s->environment && !weft_surroundings_are(s->environment) ? s->environment : NULL,
                                s->mesh && !weft_mesh_is_built_in(s->mesh) ? s->mesh : NULL};
    for (size_t i = 0; i < sizeof file / sizeof file[0]; i++)
        if (file[i] && access(file[i], F_OK) != 0)
            return weft_fail(error, WEFT_BAD_INPUT, "'%s' shows the %s '%s', which is not there", source, kind[i],
                             file[i]);
    return WEFT_OK;
}

double weft_settings_repeat(const weft_settings *settings, const weft_mesh *mesh, double material_width_mm,
                            double plane_mm)
{
    if (!settings->real_size || !(mesh->size > 0 && mesh->coordinate_length > 0 && material_width_mm > 0))
        return settings->scene.repeat;
    bool is_plane = strcmp(settings->mesh, "plane") == 0;
    double unit_mm = settings->mesh_unit_mm;
    double size_mm = settings->mesh_size_mm > 0              ? settings->mesh_size_mm
                     : is_plane                              ? plane_mm
                     : unit_mm > 0                           ? unit_mm * mesh->size
                     : strcmp(settings->mesh, "sphere") == 0 ? WEFT_SETTINGS_SPHERE_MM
                                                             : WEFT_SETTINGS_MESH_MM;
    return mesh->coordinate_length * size_mm / (mesh->size * material_width_mm);
}

void weft_settings_lay_plane(const weft_settings *settings, double proportion, weft_mesh *mesh)
{
    if (strcmp(settings->mesh, "plane") != 0 || !settings->real_size || settings->mesh_size_mm > 0)
        return;
    for (int i = 0; i < mesh->vertex_count; i++) {
        mesh->vertex[i].position[1] *= (float)proportion;
        mesh->vertex[i].coordinate[1] *= (float)proportion;
    }
}

/* ---- Pictures ---- */

bool weft_settings_is_picture(const char *path)
{
    return has_extension(path, ".png") || weft_settings_is_linear(path);
}

bool weft_settings_is_linear(const char *path)
{
    return has_extension(path, ".exr") || has_extension(path, ".tif") || has_extension(path, ".tiff");
}

static weft_code draw(const char *path, weft_player *player, const weft_settings *settings, const char *text,
                      const weft_progress *progress, weft_error *error)
{
    weft_image image = {0};
    weft_scene scene = settings->scene;
    bool is_linear = weft_settings_is_linear(path);
    /* Linear differences are numbers, and the scale would cover some. */
    scene.labels &= !(is_linear && scene.layout == WEFT_LAYOUT_DIFFERENCE);
    WEFT_TRY(weft_player_picture(player, &scene, settings->width, settings->height, settings->samples, progress, &image,
                                 error));
    if (!is_linear)
        weft_scene_show(&settings->scene, &image);
    weft_code code = weft_image_write_settings(path, &image, description, text, error);
    weft_image_free(&image);
    return code;
}

weft_code weft_settings_draw(const char *path, weft_player *player, const weft_settings *settings,
                             const weft_progress *progress, weft_error *error)
{
    char *text = NULL;
    weft_settings written = {0};
    WEFT_TRY(weft_settings_format(settings, path, &text, error));
    weft_code code = weft_settings_parse(text, strlen(text), path, &written, error);
    if (code == WEFT_OK)
        code = draw(path, player, &written, text, progress, error);
    weft_settings_free(&written);
    free(text);
    return code;
}
