#include "player/settings/schema.h"

#include "btf/file_kind.h"
#include "player/scene/surroundings.h"
#include "player/settings/settings.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

_Static_assert(sizeof(weft_mode) == sizeof(int) && sizeof(weft_layout) == sizeof(int) &&
                   sizeof(weft_level_choice) == sizeof(int) && sizeof(weft_filter) == sizeof(int) &&
                   sizeof(weft_tone) == sizeof(int) && sizeof(weft_raw_format) == sizeof(int),
               "choices are read and written as int");

/* ---- Options that set more than the one value, or not as it stands ---- */

void weft_settings_light(weft_settings *s, const char *surroundings)
{
    weft_scene *scene = &s->scene;
    weft_surroundings_light(surroundings, scene);
    if (!weft_settings_has(s, "shadows"))
        scene->shadows = true;
    if (!weft_settings_has(s, "ground"))
        scene->ground = true;
    if (!weft_settings_has(s, "tone"))
        scene->tone = WEFT_TONE_SOFT;
}

/* Where `text` with commas names words, calls `take` with the index of each. */
static weft_code take_words(const weft_option *option, const char *text, const char *const *words, weft_settings *s,
                            weft_code (*take)(weft_settings *s, int index, weft_error *error), weft_error *error)
{
    char word[32];
    for (const char *at = text; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        size_t length = strcspn(at, ",");
        int index;
        snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word - 1), at);
        WEFT_TRY(weft_option_word(option->name, word, words, &index, error));
        WEFT_TRY(take(s, index, error));
    }
    return WEFT_OK;
}

/* ---- What is shown ---- */

static weft_code choose_file(const weft_option *option, const char *text, void *target, weft_error *error)
{
    (void)option;
    weft_settings *s = target;
    weft_file_kind kind;
    /* A file of another kind, or none, is refused as no material. */
    if (weft_file_kind_of(text, &kind, NULL) != WEFT_OK)
        kind = WEFT_FILE_MATERIAL;
    char **shown = kind == WEFT_FILE_DATASET                                    ? &s->dataset
                   : kind == WEFT_FILE_WEAVE || kind == WEFT_FILE_MICROCYLINDER ? &s->weave
                                                                                : &s->material;
    if (*shown && shown != &s->material)
        return weft_fail(error, WEFT_BAD_USAGE, "'%s' and '%s' are of one kind: one at a time", text, *shown);
    return weft_option_copy(text, shown, error);
}

/* `split` is known once the files are: no pane as yet. */
static weft_code take_mode(weft_settings *s, int mode, weft_error *error)
{
    weft_scene *scene = &s->scene;
    if (scene->pane_count == WEFT_MODE_COUNT || (mode == WEFT_MODE_COUNT && scene->pane_count > 0))
        return weft_fail(error, WEFT_BAD_USAGE, "--mode names at most %d modes, or split", WEFT_MODE_COUNT);
    s->split = mode == WEFT_MODE_COUNT;
    if (!s->split)
        scene->pane[scene->pane_count++] = (weft_mode)mode;
    return WEFT_OK;
}

static weft_code choose_modes(const weft_option *option, const char *text, void *target, weft_error *error)
{
    const char *const words[] = {weft_mode_names[0], weft_mode_names[1], weft_mode_names[2], "split", NULL};
    weft_settings *s = target;
    s->scene.pane_count = 0;
    return take_words(option, text, words, s, take_mode, error);
}

static weft_code take_overlay(weft_settings *s, int index, weft_error *error)
{
    (void)error;
    s->scene.show_level |= index == 0;
    s->scene.show_extrapolation |= index == 1;
    return WEFT_OK;
}

static weft_code choose_overlays(const weft_option *option, const char *text, void *target, weft_error *error)
{
    static const char *const words[] = {"level", "extrapolation", "none", NULL};
    weft_settings *s = target;
    s->scene.show_level = s->scene.show_extrapolation = false;
    return take_words(option, text, words, s, take_overlay, error);
}

static weft_code choose_no_labels(const weft_option *option, const char *text, void *target, weft_error *error)
{
    (void)option;
    (void)text;
    (void)error;
    ((weft_settings *)target)->scene.labels = false;
    return WEFT_OK;
}

/* ---- Mesh and camera ---- */

static weft_code choose_repeat(const weft_option *option, const char *text, void *target, weft_error *error)
{
    weft_settings *s = target;
    s->real_size = false;
    return weft_option_number(option->name, text, 1e-3, 1e6, &s->scene.repeat, error);
}

static weft_code choose_mesh_size(const weft_option *option, const char *text, void *target, weft_error *error)
{
    weft_settings *s = target;
    s->real_size = true;
    return weft_option_number(option->name, text, 1e-3, 1e6, &s->mesh_size_mm, error);
}

static weft_code choose_mesh_unit(const weft_option *option, const char *text, void *target, weft_error *error)
{
    static const char *const words[] = {"mm", "cm", "m", NULL};
    static const double unit_mm[] = {1, 10, 1000};
    weft_settings *s = target;
    int unit;
    WEFT_TRY(weft_option_word(option->name, text, words, &unit, error));
    s->mesh_unit_mm = unit_mm[unit];
    s->real_size = true;
    return WEFT_OK;
}

static weft_code choose_camera(const weft_option *option, const char *text, void *target, weft_error *error)
{
    weft_settings *s = target;
    double number[3];
    WEFT_TRY(weft_option_numbers(option->name, text, 3, number, error));
    if (fabs(number[1]) > 90 || !(number[2] > 1 && number[2] <= 1e9))
        return weft_fail(error, WEFT_BAD_USAGE,
                         "--camera needs an elevation of at most 90 degrees and a distance over 1, not '%s'", text);
    s->scene.orbit = (weft_orbit){
        .azimuth_rad = weft_rad_of_deg(number[0]), .elevation_rad = weft_rad_of_deg(number[1]), .distance = number[2]};
    return WEFT_OK;
}

/* ---- Light ---- */

static weft_code read_light(const char *text, weft_light *light, weft_error *error)
{
    double number[5] = {0, 0, 1};
    int count = 1;
    for (const char *at = text; *at; at++)
        count += *at == ',';
    if (count != 2 && count != 3 && count != 5)
        return weft_fail(error, WEFT_BAD_USAGE, "--light needs 2, 3 or 5 numbers with commas, not '%s'", text);
    WEFT_TRY(weft_option_numbers("light", text, count, number, error));
    if (fabs(number[0]) > 90)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "--light %s stands below the horizon: its first number is degrees from up, "
                         "at most 90",
                         text);
    if (count < 5)
        number[3] = number[4] = number[2];
    *light = (weft_light){{weft_rad_of_deg(number[0]), weft_rad_of_deg(number[1])}, {number[2], number[3], number[4]}};
    for (int c = 0; c < 3; c++)
        if (!(light->irradiance[c] >= 0 && light->irradiance[c] <= 1e9))
            return weft_fail(error, WEFT_BAD_USAGE, "--light needs a strength from 0 to 1e9, not '%s'", text);
    return WEFT_OK;
}

static weft_code choose_light(const weft_option *option, const char *text, void *target, weft_error *error)
{
    (void)option;
    weft_settings *s = target;
    weft_scene *scene = &s->scene;
    if (!s->has_lights)
        scene->light_count = 0;
    s->has_lights = true;
    if (strcmp(text, "none") == 0)
        return WEFT_OK;
    if (scene->light_count == WEFT_SCENE_MAX_LIGHTS)
        return weft_fail(error, WEFT_BAD_USAGE, "at most %d lights", WEFT_SCENE_MAX_LIGHTS);
    return read_light(text, &scene->light[scene->light_count++], error);
}

static weft_code choose_environment(const weft_option *option, const char *text, void *target, weft_error *error)
{
    (void)option;
    weft_settings *s = target;
    weft_scene *scene = &s->scene;
    bool off = strcmp(text, "off") == 0 || strcmp(text, "none") == 0;
    const weft_scene before = *scene;
    if (weft_surroundings_are(text))
        weft_settings_light(s, text);
    else if (!off && !s->source)
        scene->light_count = 0;
    scene->environment = !off;
    if (s->has_lights) {
        memcpy(scene->light, before.light, sizeof scene->light);
        scene->light_count = before.light_count;
        scene->key_size_rad = before.key_size_rad;
    }
    return weft_option_copy(off ? NULL : text, &s->environment, error);
}

/* ---- Evaluation ---- */

static weft_code choose_level(const weft_option *option, const char *text, void *target, weft_error *error)
{
    weft_scene *scene = &((weft_settings *)target)->scene;
    scene->level_choice = strcmp(text, "auto") == 0      ? WEFT_LEVEL_TRILINEAR
                          : strcmp(text, "nearest") == 0 ? WEFT_LEVEL_NEAREST
                          : strcmp(text, "none") == 0    ? WEFT_LEVEL_NONE
                                                         : WEFT_LEVEL_FIXED;
    if (scene->level_choice != WEFT_LEVEL_FIXED)
        return WEFT_OK;
    return weft_option_number(option->name, text, 0, WEFT_MATERIAL_MAX_LEVELS, &scene->level, error);
}

static weft_code take_lobe(weft_settings *s, int index, weft_error *error)
{
    (void)error;
    if (index < WEFT_SCENE_MAX_LOBES)
        s->scene.lobe[index] = true;
    return WEFT_OK;
}

static weft_code choose_lobes(const weft_option *option, const char *text, void *target, weft_error *error)
{
    static const char *const words[] = {"1", "2", "3", "none", NULL};
    weft_settings *s = target;
    memset(s->scene.lobe, 0, sizeof s->scene.lobe);
    return take_words(option, text, words, s, take_lobe, error);
}

static weft_code choose_tables(const weft_option *option, const char *text, void *target, weft_error *error)
{
    static const char *const words[] = {"none", "view", "light", "both", NULL};
    weft_scene *scene = &((weft_settings *)target)->scene;
    int tables = 0;
    WEFT_TRY(weft_option_word(option->name, text, words, &tables, error));
    scene->view_table = tables & 1;
    scene->light_table = tables & 2;
    return WEFT_OK;
}

/* ---- The table ---- */

enum { SHOWN = 1, MESH_AND_CAMERA, LIGHT, EVALUATION };

static const char *const layout_words[] = {"panes", "wipe", "difference", NULL};
static const char *const level_words[] = {"trilinear", "nearest", "none", "fixed", NULL};
static const char *const filter_words[] = {"auto", "exact", "stochastic", NULL};
static const char *const raw_format_words[] = {"auto", "half", "rgb9e5", "bc6h", NULL};
static const char *const tone_words[] = {"clip", "soft", NULL};

#define SETTING(name, ...)                                                                                             \
    {                                                                                                                  \
        .key = (name), .option = { __VA_ARGS__ }                                                                       \
    }
#define ARRAY(size, name, ...)                                                                                         \
    {                                                                                                                  \
        .key = (name), .option = {__VA_ARGS__}, .count = (size)                                                        \
    }
#define OPTION(word, value, titled, text) .name = (word), .argument = (value), .group = (titled), .help = (text)
#define AT(value) .offset = offsetof(weft_settings, value)
#define NAME(value) .kind = WEFT_OPTION_NAME, AT(value)
#define SWITCH(value) .kind = WEFT_OPTION_SWITCH, AT(value)
#define CHOICE(value, list) .kind = WEFT_OPTION_CHOICE, AT(value), .words = (list)
#define WHOLE(value, least, most) .kind = WEFT_OPTION_WHOLE, AT(value), .low = (least), .high = (most)
#define NUMBER(value, least, most) .kind = WEFT_OPTION_NUMBER, AT(value), .low = (least), .high = (most)
#define ANGLE(value) .kind = WEFT_OPTION_ANGLE, AT(value)

/* As far as a camera or a light may have been turned, degrees. */
#define TURNED .low = -3.6e6, .high = 3.6e6

#define LIGHT_ANGLE(value) .kind = WEFT_OPTION_ANGLE, .offset = offsetof(weft_light, value), TURNED

static const weft_setting light[] = {
    {.key = "theta_deg", .option = {LIGHT_ANGLE(direction.theta_rad)}},
    {.key = "phi_deg", .option = {LIGHT_ANGLE(direction.phi_rad)}},
    {.key = "irradiance",
     .option = {.kind = WEFT_OPTION_NUMBER, .offset = offsetof(weft_light, irradiance), .low = 0, .high = 1e9},
     .count = 3},
    {0},
};

/* In the order of the text. */
static const weft_setting schema[] = {
    SETTING("files.material", .argument = "NAME.weft|NAME.btf.h5|CLOTH.wv|CLOTH.mc", NAME(material),
            .read = choose_file),
    SETTING("files.dataset", OPTION("raw", "NAME.btf.h5", SHOWN, "Show this dataset in mode raw"), NAME(dataset)),
    SETTING("files.weave",
            OPTION("weave", "CLOTH.wv|CLOTH.mc", SHOWN, "Show this weave or microcylinder cloth in mode analytic"),
            NAME(weave)),
    SETTING("files.environment",
            OPTION("environment", "studio|overcast|sky|MAP|none", LIGHT,
                   "Light from all around with a key light of its own: studio, unless there is a --light; or from a "
                   "map of the "
                   "sphere, .hdr or .exr, twice as wide as high. none: the lights alone"),
            NAME(environment), .read = choose_environment),
    SETTING("files.mesh",
            OPTION("mesh", "MESH", MESH_AND_CAMERA,
                   "drape (default), sphere, plane, or an OBJ file with texture coordinates"),
            NAME(mesh)),

    SETTING("picture.width", WHOLE(width, 1, WEFT_SETTINGS_MAX_SIDE)),
    SETTING("picture.height", WHOLE(height, 1, WEFT_SETTINGS_MAX_SIDE)),
    SETTING(NULL,
            OPTION("size", "WxH", MESH_AND_CAMERA,
                   "Size of the picture in pixels (default: 960x540), or of the window (default: 1280x800)"),
            .kind = WEFT_OPTION_SIZE, AT(width), .high = WEFT_SETTINGS_MAX_SIDE),
    SETTING("picture.samples",
            OPTION("samples", "N", MESH_AND_CAMERA,
                   "Draw N x N frames within each pixel of a written picture (default: 3)"),
            WHOLE(samples, 1, WEFT_SETTINGS_MAX_SAMPLES)),

    SETTING("size.real", SWITCH(real_size)),
    SETTING(
        "size.repeat",
        OPTION("repeat", "N", MESH_AND_CAMERA,
               "Materials across one unit of texture coordinates (default: as many as give the cloth its real size)"),
        NUMBER(scene.repeat, 1e-9, 1e9), .read = choose_repeat),
    SETTING("size.mesh_mm",
            OPTION("mesh-size", "MM", MESH_AND_CAMERA,
                   "Side of the plane or of the draped cloth, diameter of the sphere, longest side of an OBJ file "
                   "(default: 300; sphere: 60; plane: the material once, or 20 mm of a weave)"),
            NUMBER(mesh_size_mm, 0, 1e9), .read = choose_mesh_size),
    SETTING("size.mesh_unit_mm",
            OPTION("mesh-unit", "mm|cm|m", MESH_AND_CAMERA, "Unit of an OBJ file, instead of --mesh-size"),
            NUMBER(mesh_unit_mm, 0, 1e9), .read = choose_mesh_unit),
    ARRAY(2, "size.weave_tiles",
          OPTION("tiles", "X,Y", SHOWN,
                 "Tiles of a .wv across the material (default: as its file says, else as the virtual rig lays it)"),
          .kind = WEFT_OPTION_PAIR, AT(tiles), .high = 1e6),

    SETTING("camera.azimuth_deg", ANGLE(scene.orbit.azimuth_rad), TURNED),
    SETTING("camera.elevation_deg", ANGLE(scene.orbit.elevation_rad), .low = -90, .high = 90),
    SETTING("camera.distance", NUMBER(scene.orbit.distance, 1 + 1e-9, 1e9)),
    SETTING("camera.pan_right", NUMBER(scene.orbit.pan_right, -1e6, 1e6)),
    SETTING("camera.pan_up", NUMBER(scene.orbit.pan_up, -1e6, 1e6)),
    SETTING(NULL,
            OPTION("camera", "AZIMUTH,ELEVATION,DISTANCE", MESH_AND_CAMERA,
                   "Camera: azimuth and elevation in degrees, distance in radii of the mesh (default: -70,28,3.6; "
                   "plane: -90,75,3)"),
            .read = choose_camera),

    {.key = "light.lights",
     .option = {OPTION("light", "THETA,PHI[,...]", LIGHT,
                       "A light: degrees from up and around it, and its irradiance over pi (default: 45,-110,1). Up to "
                       "four; the first is the key light. none: no light but the environment"),
                AT(scene.light), .read = choose_light},
     .part = light,
     .most = WEFT_SCENE_MAX_LIGHTS,
     .stride = sizeof(weft_light),
     .count_offset = offsetof(weft_settings, scene.light_count)},
    SETTING("light.shadows", OPTION("shadows", "on|off", LIGHT, "Shadows of the key light and of the environment"),
            .may_be_empty = true, SWITCH(scene.shadows)),
    SETTING(
        "light.key_size_deg",
        OPTION("light-size", "DEG", LIGHT, "Radius of the key light on the sky: how soft its shadow is (default: 0)"),
        ANGLE(scene.key_size_rad), .low = 0, .high = 45),
    SETTING("light.ground", OPTION("ground", "on|off", LIGHT, "A ground that takes the shadows, and a backdrop"),
            .may_be_empty = true, SWITCH(scene.ground)),
    SETTING("light.environment.lit", SWITCH(scene.environment)),
    SETTING("light.environment.turn_deg", OPTION("environment-turn", "DEG", LIGHT, "Turn the map about the vertical"),
            ANGLE(scene.environment_turn_rad), TURNED),
    SETTING("light.environment.strength",
            OPTION("environment-strength", "X", LIGHT, "Multiply its radiance (default: 1)"),
            NUMBER(scene.environment_strength, 0, 1e9)),
    SETTING("light.environment.reference",
            OPTION("environment-reference", "on|off", LIGHT, "Sum every light of the map: slow"), .may_be_empty = true,
            SWITCH(scene.environment_reference)),
    SETTING("light.exposure", OPTION("exposure", "X", LIGHT, "Brightness; 1 shows reflectance"),
            NUMBER(scene.exposure, 1e-9, 1e9)),
    SETTING("light.tone",
            OPTION("tone", "clip|soft", LIGHT, "Cut radiance off at 1 (default), or bend it to 1 from 1/2 on"),
            CHOICE(scene.tone, tone_words)),

    SETTING(
        "mip.level",
        OPTION(
            "level", "auto|nearest|none|N", EVALUATION,
            "Mip level: between the two that fit the pixel's footprint, the nearer of them, the finest, or this one"),
        CHOICE(scene.level_choice, level_words), .read = choose_level),
    SETTING("mip.fixed_level", NUMBER(scene.level, 0, WEFT_MATERIAL_MAX_LEVELS)),
    SETTING("mip.filter",
            OPTION("filter", "auto|exact|stochastic", EVALUATION,
                   "Interpolate all neighbours in every frame, or one at random: noisy frames with the same mean"),
            CHOICE(scene.filter, filter_words)),

    SETTING("model.raw_format",
            OPTION("raw-format", "auto|half|rgb9e5|bc6h", SHOWN,
                   "Keep its samples as half floats (8 bytes), with a shared exponent (4) or in compressed blocks (1); "
                   "auto: the best that fits"),
            CHOICE(raw_format, raw_format_words)),
    SETTING("model.relief",
            OPTION("relief", "on|off", EVALUATION,
                   "See the dataset, and the components of a material, through the heights that `weft relief` found "
                   "(default: on, where there are some)"),
            SWITCH(scene.relief)),
    SETTING(
        "model.components",
        OPTION("components", "N", EVALUATION,
               "Only the first N components of the material, in steps of 4; 0: its lobes (default: all components)"),
        .former_name = "layers", WHOLE(scene.components, 0, WEFT_COMPONENTS_MAX)),
    ARRAY(WEFT_SCENE_MAX_LOBES, "model.lobes",
          OPTION("lobes-on", "N[,N...]|none", EVALUATION, "Only these lobes of the material, counted from 1"),
          SWITCH(scene.lobe), .read = choose_lobes),
    SETTING("model.view_table", SWITCH(scene.view_table)),
    SETTING("model.light_table", SWITCH(scene.light_table)),
    SETTING(NULL, OPTION("tables", "both|view|light|none", EVALUATION, "Only these tables of the material"),
            .read = choose_tables),
    SETTING("model.noise_seed",
            OPTION("noise", "SEED|off", EVALUATION,
                   "Irregularities of the weave, as its file gives them, from this number on (default: off)"),
            .kind = WEFT_OPTION_NOISE, AT(scene.noise_seed)),

    SETTING("view.layout",
            OPTION("layout", "LAYOUT", SHOWN,
                   "panes (default): side by side; wipe: first mode left of the divider, second right; difference: "
                   "second - first"),
            CHOICE(scene.layout, layout_words)),
    ARRAY(
        WEFT_MODE_COUNT, "view.modes",
        OPTION("mode", "MODE[,MODE...]", SHOWN, "raw, compressed, analytic: one pane each; split: all that are given"),
        CHOICE(scene.pane, weft_mode_names), .read = choose_modes),
    SETTING("view.panes", WHOLE(scene.pane_count, 1, WEFT_MODE_COUNT)),
    SETTING("view.divider", OPTION("divider", "X", SHOWN, "Where a wipe changes, 0 (left) to 1 (default: 0.5)"),
            NUMBER(scene.divider, 0, 1)),
    SETTING("view.show_level", SWITCH(scene.show_level)),
    SETTING("view.show_extrapolation", SWITCH(scene.show_extrapolation)),
    SETTING("view.labels", SWITCH(scene.labels)),
    SETTING(NULL,
            OPTION("show", "level|extrapolation|none", EVALUATION,
                   "The mip level in false colour; a tint where view or light lies beyond what was measured"),
            .read = choose_overlays),
    SETTING(NULL,
            OPTION("no-labels", NULL, EVALUATION, "Leave out the names of the modes and the scale of a difference"),
            .read = choose_no_labels),

    SETTING(NULL,
            OPTION("settings", "PICTURE", SHOWN,
                   "Start from the settings in a picture of Weft's, or in a .json file; other options change them"),
            .kind = WEFT_OPTION_TEXT, .offset = offsetof(weft_settings, source)),
    {0},
};

const weft_setting *weft_settings_schema(void)
{
    return schema;
}

const char *weft_settings_group(int group)
{
    static const char *const title[] = {"", "What is shown:", "Mesh and camera:", "Light:", "Evaluation:"};
    return (size_t)group < sizeof title / sizeof *title ? title[group] : NULL;
}

bool weft_settings_has(const weft_settings *settings, const char *name)
{
    for (int i = 0; i < (int)(sizeof schema / sizeof *schema); i++)
        if (schema[i].option.name && strcmp(schema[i].option.name, name) == 0)
            return settings->given >> i & 1;
    return false;
}

_Static_assert(sizeof schema / sizeof *schema <= 64, "each setting has its bit in `given`");
