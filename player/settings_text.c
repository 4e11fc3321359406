#include "player/settings.h"

#include "btf/json_fields.h"
#include "btf/json_text.h"
#include "player/relative_path.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- What a picture's text holds, in its order ---- */

_Static_assert(sizeof(weft_mode) == sizeof(int) && sizeof(weft_layout) == sizeof(int) &&
                   sizeof(weft_level_choice) == sizeof(int) && sizeof(weft_filter) == sizeof(int) &&
                   sizeof(weft_tone) == sizeof(int) && sizeof(weft_raw_format) == sizeof(int),
               "choices are read and written as int");

enum { VERSION = 1 };

typedef weft_json_field field;

static const char *const mode_names[] = {"raw", "compressed", "analytic", NULL};
static const char *const layout_names[] = {"panes", "wipe", "difference", NULL};
static const char *const level_names[] = {"trilinear", "nearest", "none", "fixed", NULL};
static const char *const filter_names[] = {"auto", "exact", "stochastic", NULL};
static const char *const raw_format_names[] = {"auto", "half", "rgb9e5", "bc6h", NULL};
static const char *const tone_names[] = {"clip", "soft", NULL};

/* As far as a camera may have been turned, degrees. */
#define TURNED .low = -3.6e6, .high = 3.6e6
#define PAN .low = -1e6, .high = 1e6
#define POSITIVE .low = 1e-9, .high = 1e9

static const field file_fields[] = {
    {.name = "material", .kind = WEFT_JSON_TEXT, .offset = offsetof(weft_settings, material)},
    {.name = "dataset", .kind = WEFT_JSON_TEXT, .offset = offsetof(weft_settings, dataset)},
    {.name = "weave", .kind = WEFT_JSON_TEXT, .offset = offsetof(weft_settings, weave)},
    {.name = "environment", .kind = WEFT_JSON_TEXT, .offset = offsetof(weft_settings, environment)},
    {.name = "mesh", .kind = WEFT_JSON_TEXT, .offset = offsetof(weft_settings, mesh)},
    {0},
};

static const field picture_fields[] = {
    {.name = "width",
     .kind = WEFT_JSON_WHOLE,
     .offset = offsetof(weft_settings, width),
     .low = 1,
     .high = WEFT_SETTINGS_MAX_SIDE},
    {.name = "height",
     .kind = WEFT_JSON_WHOLE,
     .offset = offsetof(weft_settings, height),
     .low = 1,
     .high = WEFT_SETTINGS_MAX_SIDE},
    {.name = "samples",
     .kind = WEFT_JSON_WHOLE,
     .offset = offsetof(weft_settings, samples),
     .low = 1,
     .high = WEFT_SETTINGS_MAX_SAMPLES},
    {0},
};

static const field tile_element = {.kind = WEFT_JSON_NUMBER, .low = 0, .high = 1e6};

static const field size_fields[] = {
    {.name = "real", .kind = WEFT_JSON_SWITCH, .offset = offsetof(weft_settings, real_size)},
    {.name = "repeat", .kind = WEFT_JSON_NUMBER, .offset = offsetof(weft_settings, scene.repeat), POSITIVE},
    {.name = "mesh_mm",
     .kind = WEFT_JSON_NUMBER,
     .offset = offsetof(weft_settings, mesh_size_mm),
     .low = 0,
     .high = 1e9},
    {.name = "mesh_unit_mm",
     .kind = WEFT_JSON_NUMBER,
     .offset = offsetof(weft_settings, mesh_unit_mm),
     .low = 0,
     .high = 1e9},
    {.name = "weave_tiles",
     .kind = WEFT_JSON_LIST,
     .offset = offsetof(weft_settings, tiles),
     .part = &tile_element,
     .least = 2,
     .most = 2,
     .stride = sizeof(double)},
    {0},
};

static const field camera_fields[] = {
    {.name = "azimuth_deg",
     .kind = WEFT_JSON_ANGLE,
     .offset = offsetof(weft_settings, scene.orbit.azimuth_rad),
     TURNED},
    {.name = "elevation_deg",
     .kind = WEFT_JSON_ANGLE,
     .offset = offsetof(weft_settings, scene.orbit.elevation_rad),
     .low = -90,
     .high = 90},
    {.name = "distance",
     .kind = WEFT_JSON_NUMBER,
     .offset = offsetof(weft_settings, scene.orbit.distance),
     .low = 1 + 1e-9,
     .high = 1e9},
    {.name = "pan_right", .kind = WEFT_JSON_NUMBER, .offset = offsetof(weft_settings, scene.orbit.pan_right), PAN},
    {.name = "pan_up", .kind = WEFT_JSON_NUMBER, .offset = offsetof(weft_settings, scene.orbit.pan_up), PAN},
    {0},
};

static const field irradiance_element = {.kind = WEFT_JSON_NUMBER, .low = 0, .high = 1e9};

static const field light_fields[] = {
    {.name = "theta_deg", .kind = WEFT_JSON_ANGLE, .offset = offsetof(weft_light, direction.theta_rad), TURNED},
    {.name = "phi_deg", .kind = WEFT_JSON_ANGLE, .offset = offsetof(weft_light, direction.phi_rad), TURNED},
    {.name = "irradiance",
     .kind = WEFT_JSON_LIST,
     .offset = offsetof(weft_light, irradiance),
     .part = &irradiance_element,
     .least = 3,
     .most = 3,
     .stride = sizeof(double)},
    {0},
};
static const field light_element = {.kind = WEFT_JSON_PART, .part = light_fields};

static const field environment_fields[] = {
    {.name = "lit", .kind = WEFT_JSON_SWITCH, .offset = offsetof(weft_settings, scene.environment)},
    {.name = "turn_deg",
     .kind = WEFT_JSON_ANGLE,
     .offset = offsetof(weft_settings, scene.environment_turn_rad),
     TURNED},
    {.name = "strength",
     .kind = WEFT_JSON_NUMBER,
     .offset = offsetof(weft_settings, scene.environment_strength),
     .low = 0,
     .high = 1e9},
    {.name = "reference", .kind = WEFT_JSON_SWITCH, .offset = offsetof(weft_settings, scene.environment_reference)},
    {0},
};

static const field lighting_fields[] = {
    {.name = "lights",
     .kind = WEFT_JSON_LIST,
     .offset = offsetof(weft_settings, scene.light),
     .part = &light_element,
     .most = WEFT_SCENE_MAX_LIGHTS,
     .stride = sizeof(weft_light),
     .count_offset = offsetof(weft_settings, scene.light_count)},
    {.name = "shadows", .kind = WEFT_JSON_SWITCH, .offset = offsetof(weft_settings, scene.shadows)},
    {.name = "environment", .kind = WEFT_JSON_PART, .part = environment_fields},
    {.name = "exposure", .kind = WEFT_JSON_NUMBER, .offset = offsetof(weft_settings, scene.exposure), POSITIVE},
    {.name = "tone", .kind = WEFT_JSON_CHOICE, .offset = offsetof(weft_settings, scene.tone), .choice = tone_names},
    {0},
};

static const field mip_fields[] = {
    {.name = "level",
     .kind = WEFT_JSON_CHOICE,
     .offset = offsetof(weft_settings, scene.level_choice),
     .choice = level_names},
    {.name = "fixed_level",
     .kind = WEFT_JSON_NUMBER,
     .offset = offsetof(weft_settings, scene.level),
     .low = 0,
     .high = WEFT_MATERIAL_MAX_LEVELS},
    {.name = "filter",
     .kind = WEFT_JSON_CHOICE,
     .offset = offsetof(weft_settings, scene.filter),
     .choice = filter_names},
    {0},
};

static const field switch_element = {.kind = WEFT_JSON_SWITCH};

static const field model_fields[] = {
    {.name = "raw_format",
     .kind = WEFT_JSON_CHOICE,
     .offset = offsetof(weft_settings, raw_format),
     .choice = raw_format_names},
    {.name = "lobes",
     .kind = WEFT_JSON_LIST,
     .offset = offsetof(weft_settings, scene.lobe),
     .part = &switch_element,
     .least = WEFT_SCENE_MAX_LOBES,
     .most = WEFT_SCENE_MAX_LOBES,
     .stride = sizeof(bool)},
    {.name = "view_table", .kind = WEFT_JSON_SWITCH, .offset = offsetof(weft_settings, scene.view_table)},
    {.name = "light_table", .kind = WEFT_JSON_SWITCH, .offset = offsetof(weft_settings, scene.light_table)},
    {.name = "table_bits",
     .kind = WEFT_JSON_WHOLE,
     .offset = offsetof(weft_settings, scene.table_bits),
     .low = 1,
     .high = 8},
    {.name = "noise_seed",
     .kind = WEFT_JSON_WHOLE,
     .offset = offsetof(weft_settings, scene.noise_seed),
     .low = 0,
     .high = INT_MAX},
    {0},
};

static const field pane_element = {.kind = WEFT_JSON_CHOICE, .choice = mode_names};

static const field view_fields[] = {
    {.name = "layout",
     .kind = WEFT_JSON_CHOICE,
     .offset = offsetof(weft_settings, scene.layout),
     .choice = layout_names},
    {.name = "modes",
     .kind = WEFT_JSON_LIST,
     .offset = offsetof(weft_settings, scene.pane),
     .part = &pane_element,
     .least = WEFT_MODE_COUNT,
     .most = WEFT_MODE_COUNT,
     .stride = sizeof(weft_mode)},
    {.name = "panes",
     .kind = WEFT_JSON_WHOLE,
     .offset = offsetof(weft_settings, scene.pane_count),
     .low = 1,
     .high = WEFT_MODE_COUNT},
    {.name = "divider",
     .kind = WEFT_JSON_NUMBER,
     .offset = offsetof(weft_settings, scene.divider),
     .low = 0,
     .high = 1},
    {.name = "show_level", .kind = WEFT_JSON_SWITCH, .offset = offsetof(weft_settings, scene.show_level)},
    {.name = "show_extrapolation",
     .kind = WEFT_JSON_SWITCH,
     .offset = offsetof(weft_settings, scene.show_extrapolation)},
    {.name = "labels", .kind = WEFT_JSON_SWITCH, .offset = offsetof(weft_settings, scene.labels)},
    {0},
};

typedef struct document {
    int version;
    weft_settings settings;
} document;

#define IN_SETTINGS(table) .kind = WEFT_JSON_PART, .offset = offsetof(document, settings), .part = (table)

static const field document_fields[] = {
    {.name = "version",
     .kind = WEFT_JSON_WHOLE,
     .offset = offsetof(document, version),
     .low = VERSION,
     .high = VERSION},
    {.name = "files", IN_SETTINGS(file_fields)},
    {.name = "picture", IN_SETTINGS(picture_fields)},
    {.name = "size", IN_SETTINGS(size_fields)},
    {.name = "camera", IN_SETTINGS(camera_fields)},
    {.name = "light", IN_SETTINGS(lighting_fields)},
    {.name = "mip", IN_SETTINGS(mip_fields)},
    {.name = "model", IN_SETTINGS(model_fields)},
    {.name = "view", IN_SETTINGS(view_fields)},
    {0},
};

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

/* The result is owned. A file that is called as a built-in mesh is kept apart from it by its folder. */
static weft_code name_beside(const char *path, bool is_mesh, const char *beside, char **name, weft_error *error)
{
    if (is_mesh && weft_mesh_is_built_in(path)) {
        *name = strdup(path);
        return *name ? WEFT_OK : weft_fail_memory(error, path, strlen(path));
    }
    WEFT_TRY(weft_path_relative_to(path, beside, name, error));
    if (!is_mesh || !weft_mesh_is_built_in(*name))
        return WEFT_OK;
    char *dotted = NULL;
    int length = asprintf(&dotted, "./%s", *name);
    free(*name);
    *name = length < 0 ? NULL : dotted;
    return *name ? WEFT_OK : weft_fail_memory(error, path, strlen(path));
}

/* ---- Text ---- */

static weft_code write_text(const document *d, char **text, weft_error *error)
{
    json_t *object;
    WEFT_TRY(weft_json_write_fields(document_fields, d, &object, error));
    *text = json_dumps(object, JSON_INDENT(1) | JSON_ENSURE_ASCII);
    json_decref(object);
    return *text ? WEFT_OK : weft_fail_memory(error, "settings", 0);
}

weft_code weft_settings_format(const weft_settings *settings, const char *beside, char **text, weft_error *error)
{
    document d = {VERSION, *settings};
    char **name[FILE_COUNT], *owned[FILE_COUNT] = {0};
    weft_code code = WEFT_OK;
    list_files(&d.settings, name);
    for (int i = 0; i < FILE_COUNT; i++) {
        if (*name[i] && code == WEFT_OK)
            code = name_beside(*name[i], name[i] == &d.settings.mesh, beside, &owned[i], error);
        *name[i] = owned[i];
    }
    if (code == WEFT_OK)
        code = write_text(&d, text, error);
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
        if (!*name[i] || (name[i] == &settings->mesh && weft_mesh_is_built_in(*name[i])))
            continue;
        char *found = weft_path_beside(*name[i], source);
        if (!found)
            return weft_fail_memory(error, source, strlen(source));
        free(*name[i]);
        *name[i] = found;
    }
    return WEFT_OK;
}

weft_code weft_settings_parse(const char *text, size_t size, const char *source, weft_settings *settings,
                              weft_error *error)
{
    char where[WEFT_MESSAGE_SIZE / 2];
    json_error_t at;
    errno = 0;
    document d = {VERSION, {0}};
    snprintf(where, sizeof where, "the settings in '%s'", source);
    *settings = d.settings;
    json_t *root = json_loadb(text, size, JSON_REJECT_DUPLICATES, &at);
    if (!root)
        return weft_json_fail(error, WEFT_BAD_INPUT, "%s: line %d, column %d: %s", where, at.line, at.column, at.text);
    weft_code code = weft_settings_init(&d.settings, error);
    if (code == WEFT_OK)
        code = weft_json_read_fields(document_fields, root, where, &d, error);
    if (code == WEFT_OK && !d.settings.mesh)
        code = weft_fail(error, WEFT_BAD_INPUT, "%s: 'files.mesh' must not be null", where);
    if (code == WEFT_OK)
        code = check_light(&d.settings, where, error);
    if (code == WEFT_OK)
        code = find_files(&d.settings, source, error);
    json_decref(root);
    if (code != WEFT_OK)
        weft_settings_free(&d.settings);
    *settings = d.settings;
    return code;
}
