#include "player/settings/choices.h"

#include "btf/file_kind.h"
#include "player/scene/surroundings.h"
#include "player/settings/scene_options.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Where `text` with commas names words, calls `take` with the index of each. */
static weft_code take_words(const weft_option *option, const char *text, const char *const *words,
                            weft_scene_request *request,
                            weft_code (*take)(weft_scene_request *request, int index, weft_error *error),
                            weft_error *error)
{
    char word[32];
    for (const char *at = text; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        size_t length = strcspn(at, ",");
        int index;
        snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word - 1), at);
        WEFT_TRY(weft_option_word(option->name, word, words, &index, error));
        WEFT_TRY(take(request, index, error));
    }
    return WEFT_OK;
}

/* ---- What is shown ---- */

weft_code weft_choose_file(const weft_option *option, const char *text, void *target, weft_error *error)
{
    (void)option;
    weft_settings *s = &((weft_scene_request *)target)->settings;
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
static weft_code take_mode(weft_scene_request *request, int mode, weft_error *error)
{
    weft_scene *scene = &request->settings.scene;
    if (scene->pane_count == WEFT_MODE_COUNT || (mode == WEFT_MODE_COUNT && scene->pane_count > 0))
        return weft_fail(error, WEFT_BAD_USAGE, "--mode names at most %d modes, or split", WEFT_MODE_COUNT);
    request->split = mode == WEFT_MODE_COUNT;
    if (!request->split)
        scene->pane[scene->pane_count++] = (weft_mode)mode;
    return WEFT_OK;
}

weft_code weft_choose_modes(const weft_option *option, const char *text, void *target, weft_error *error)
{
    const char *const words[] = {weft_mode_words[0], weft_mode_words[1], weft_mode_words[2], "split", NULL};
    weft_scene_request *request = target;
    request->has_modes = true;
    request->settings.scene.pane_count = 0;
    return take_words(option, text, words, request, take_mode, error);
}

static weft_code take_overlay(weft_scene_request *request, int index, weft_error *error)
{
    (void)error;
    request->settings.scene.show_level |= index == 0;
    request->settings.scene.show_extrapolation |= index == 1;
    return WEFT_OK;
}

weft_code weft_choose_overlays(const weft_option *option, const char *text, void *target, weft_error *error)
{
    static const char *const words[] = {"level", "extrapolation", "none", NULL};
    weft_scene_request *request = target;
    request->settings.scene.show_level = request->settings.scene.show_extrapolation = false;
    return take_words(option, text, words, request, take_overlay, error);
}

weft_code weft_choose_no_labels(const weft_option *option, const char *text, void *request, weft_error *error)
{
    (void)option;
    (void)text;
    (void)error;
    ((weft_scene_request *)request)->settings.scene.labels = false;
    return WEFT_OK;
}

/* ---- Mesh and camera ---- */

weft_code weft_choose_repeat(const weft_option *option, const char *text, void *target, weft_error *error)
{
    weft_settings *s = &((weft_scene_request *)target)->settings;
    s->real_size = false;
    return weft_option_number(option->name, text, 1e-3, 1e6, &s->scene.repeat, error);
}

weft_code weft_choose_mesh_size(const weft_option *option, const char *text, void *target, weft_error *error)
{
    weft_settings *s = &((weft_scene_request *)target)->settings;
    s->real_size = true;
    return weft_option_number(option->name, text, 1e-3, 1e6, &s->mesh_size_mm, error);
}

weft_code weft_choose_mesh_unit(const weft_option *option, const char *text, void *target, weft_error *error)
{
    static const char *const words[] = {"mm", "cm", "m", NULL};
    static const double unit_mm[] = {1, 10, 1000};
    weft_settings *s = &((weft_scene_request *)target)->settings;
    int unit;
    WEFT_TRY(weft_option_word(option->name, text, words, &unit, error));
    s->mesh_unit_mm = unit_mm[unit];
    s->real_size = true;
    return WEFT_OK;
}

weft_code weft_choose_camera(const weft_option *option, const char *text, void *target, weft_error *error)
{
    weft_scene_request *request = target;
    double number[3];
    WEFT_TRY(weft_option_numbers(option->name, text, 3, number, error));
    if (fabs(number[1]) > 90 || !(number[2] > 1 && number[2] <= 1e9))
        return weft_fail(error, WEFT_BAD_USAGE,
                         "--camera needs an elevation of at most 90 degrees and a distance over 1, not '%s'", text);
    request->settings.scene.orbit = (weft_orbit){
        .azimuth_rad = weft_rad_of_deg(number[0]), .elevation_rad = weft_rad_of_deg(number[1]), .distance = number[2]};
    request->has_camera = true;
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

weft_code weft_choose_light(const weft_option *option, const char *text, void *target, weft_error *error)
{
    (void)option;
    weft_scene_request *request = target;
    weft_scene *scene = &request->settings.scene;
    if (!request->has_lights)
        scene->light_count = 0;
    request->has_lights = true;
    if (strcmp(text, "none") == 0)
        return WEFT_OK;
    if (scene->light_count == WEFT_SCENE_MAX_LIGHTS)
        return weft_fail(error, WEFT_BAD_USAGE, "at most %d lights", WEFT_SCENE_MAX_LIGHTS);
    return read_light(text, &scene->light[scene->light_count++], error);
}

weft_code weft_choose_environment(const weft_option *option, const char *text, void *target, weft_error *error)
{
    (void)option;
    weft_scene_request *request = target;
    weft_scene *scene = &request->settings.scene;
    bool off = strcmp(text, "off") == 0 || strcmp(text, "none") == 0;
    const weft_scene before = *scene;
    if (weft_surroundings_are(text))
        weft_look(request, text);
    else if (!off && !request->source)
        scene->light_count = 0;
    scene->environment = !off;
    if (request->has_lights) {
        memcpy(scene->light, before.light, sizeof scene->light);
        scene->light_count = before.light_count;
        scene->key_size_rad = before.key_size_rad;
    }
    return weft_option_copy(off ? NULL : text, &request->settings.environment, error);
}

/* ---- Evaluation ---- */

weft_code weft_choose_level(const weft_option *option, const char *text, void *target, weft_error *error)
{
    weft_scene *scene = &((weft_scene_request *)target)->settings.scene;
    scene->level_choice = strcmp(text, "auto") == 0      ? WEFT_LEVEL_TRILINEAR
                          : strcmp(text, "nearest") == 0 ? WEFT_LEVEL_NEAREST
                          : strcmp(text, "none") == 0    ? WEFT_LEVEL_NONE
                                                         : WEFT_LEVEL_FIXED;
    if (scene->level_choice != WEFT_LEVEL_FIXED)
        return WEFT_OK;
    return weft_option_number(option->name, text, 0, WEFT_MATERIAL_MAX_LEVELS, &scene->level, error);
}

static weft_code take_lobe(weft_scene_request *request, int index, weft_error *error)
{
    (void)error;
    if (index < WEFT_SCENE_MAX_LOBES)
        request->settings.scene.lobe[index] = true;
    return WEFT_OK;
}

weft_code weft_choose_lobes(const weft_option *option, const char *text, void *target, weft_error *error)
{
    static const char *const words[] = {"1", "2", "3", "none", NULL};
    weft_scene_request *request = target;
    memset(request->settings.scene.lobe, 0, sizeof request->settings.scene.lobe);
    return take_words(option, text, words, request, take_lobe, error);
}

weft_code weft_choose_tables(const weft_option *option, const char *text, void *target, weft_error *error)
{
    static const char *const words[] = {"none", "view", "light", "both", NULL};
    weft_scene *scene = &((weft_scene_request *)target)->settings.scene;
    int tables = 0;
    WEFT_TRY(weft_option_word(option->name, text, words, &tables, error));
    scene->view_table = tables & 1;
    scene->light_table = tables & 2;
    return WEFT_OK;
}
