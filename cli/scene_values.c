#include "cli/scene_values.h"

#include "cli/arguments.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Index of the word in a list that ends with NULL; wrong usage names them all. */
static int parse_word(const char *option, const char *text, const char *const *words, struct argp_state *state)
{
    char all[128] = "";
    for (int i = 0; words[i]; i++) {
        if (strcmp(words[i], text) == 0)
            return i;
        size_t used = strlen(all);
        snprintf(all + used, sizeof all - used, "%s%s", i > 0 ? ", " : "", words[i]);
    }
    argp_error(state, "--%s is one of %s, not '%s'", option, all, text);
    return 0;
}

/* Where `text` with commas names words, calls `take` with the index of each. */
static void parse_words(const char *option, const char *text, const char *const *words, scene_options *o,
                        void (*take)(scene_options *o, int index, struct argp_state *state), struct argp_state *state)
{
    char word[32];
    for (const char *at = text; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        size_t length = strcspn(at, ",");
        snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word - 1), at);
        take(o, parse_word(option, word, words, state), state);
    }
}

static bool switch_of(const char *option, const char *argument, struct argp_state *state)
{
    return argument ? parse_switch(option, argument, state) : true;
}

static void set_text(char **text, const char *value, struct argp_state *state)
{
    free(*text);
    *text = value ? strdup(value) : NULL;
    if (value && !*text)
        argp_failure(state, WEFT_SYSTEM, 0, "out of memory");
}

/* ---- What is shown ---- */

static const char *const mode_words[] = {"raw", "compressed", "analytic", "split", NULL};

/* `split` is known once the files are: no pane as yet. */
static void take_mode(scene_options *o, int mode, struct argp_state *state)
{
    weft_scene *scene = &o->settings.scene;
    if (scene->pane_count == WEFT_MODE_COUNT || (mode == WEFT_MODE_COUNT && scene->pane_count > 0))
        argp_error(state, "--mode names at most %d modes, or split", WEFT_MODE_COUNT);
    o->split = mode == WEFT_MODE_COUNT;
    if (!o->split)
        scene->pane[scene->pane_count++] = (weft_mode)mode;
}

static void apply_mode(scene_options *o, const char *argument, struct argp_state *state)
{
    o->has_modes = true;
    o->settings.scene.pane_count = 0;
    parse_words("mode", argument, mode_words, o, take_mode, state);
}

static bool apply_shown(scene_options *o, int key, const char *argument, struct argp_state *state)
{
    static const char *const layout_words[] = {"panes", "wipe", "difference", NULL};
    static const char *const format_words[] = {"auto", "half", "rgb9e5", "bc6h", NULL};
    weft_settings *s = &o->settings;
    switch (key) {
    case ARGP_KEY_ARG:
        set_text(&s->material, argument, state);
        return true;
    case KEY_RAW:
        set_text(&s->dataset, argument, state);
        return true;
    case KEY_WEAVE:
        set_text(&s->weave, argument, state);
        return true;
    case KEY_RAW_FORMAT:
        s->raw_format = (weft_raw_format)parse_word("raw-format", argument, format_words, state);
        return true;
    case KEY_TILES:
        parse_tiles("tiles", argument, &s->tiles[0], &s->tiles[1], state);
        return true;
    case KEY_MODE:
        apply_mode(o, argument, state);
        return true;
    case KEY_LAYOUT:
        s->scene.layout = (weft_layout)parse_word("layout", argument, layout_words, state);
        return true;
    case KEY_DIVIDER:
        s->scene.divider = parse_number("divider", argument, 0, 1, state);
        return true;
    case KEY_NO_LABELS:
        s->scene.labels = false;
        return true;
    default:
        return false;
    }
}

/* ---- Mesh and camera ---- */

static void apply_camera(scene_options *o, const char *text, struct argp_state *state)
{
    double number[3];
    parse_numbers("camera", text, 3, number, state);
    if (fabs(number[1]) > 90 || !(number[2] > 1 && number[2] <= 1e9))
        argp_error(state, "--camera needs an elevation of at most 90 degrees and a distance over 1, not '%s'", text);
    o->settings.scene.orbit = (weft_orbit){
        .azimuth_rad = weft_rad_of_deg(number[0]), .elevation_rad = weft_rad_of_deg(number[1]), .distance = number[2]};
    o->has_camera = true;
}

static bool apply_mesh(scene_options *o, int key, const char *argument, struct argp_state *state)
{
    static const char *const unit_words[] = {"mm", "cm", "m", NULL};
    static const double unit_mm[] = {1, 10, 1000};
    weft_settings *s = &o->settings;
    switch (key) {
    case KEY_MESH:
        set_text(&s->mesh, argument, state);
        return true;
    case KEY_MESH_SIZE:
        s->mesh_size_mm = parse_number("mesh-size", argument, 1e-3, 1e6, state);
        s->real_size = true;
        return true;
    case KEY_MESH_UNIT:
        s->mesh_unit_mm = unit_mm[parse_word("mesh-unit", argument, unit_words, state)];
        s->real_size = true;
        return true;
    case KEY_REPEAT:
        s->scene.repeat = parse_number("repeat", argument, 1e-3, 1e6, state);
        s->real_size = false;
        return true;
    case KEY_CAMERA:
        apply_camera(o, argument, state);
        return true;
    case KEY_SIZE:
        parse_size("size", argument, WEFT_SETTINGS_MAX_SIDE, &s->width, &s->height, state);
        return true;
    case KEY_SAMPLES:
        s->samples = (int)parse_whole("samples", argument, 1, WEFT_SETTINGS_MAX_SAMPLES, state);
        return true;
    default:
        return false;
    }
}

/* ---- Light ---- */

static int count_numbers(const char *text)
{
    int count = 1;
    for (; *text; text++)
        count += *text == ',';
    return count;
}

/* The first --light takes the place of the lights that were there. */
static void apply_light(scene_options *o, const char *text, struct argp_state *state)
{
    weft_scene *scene = &o->settings.scene;
    if (!o->has_lights)
        scene->light_count = 0;
    o->has_lights = true;
    if (strcmp(text, "none") == 0)
        return;
    if (scene->light_count == WEFT_SCENE_MAX_LIGHTS)
        argp_error(state, "at most %d lights", WEFT_SCENE_MAX_LIGHTS);
    double number[5] = {0, 0, 1};
    int count = count_numbers(text);
    if (count != 2 && count != 3 && count != 5)
        argp_error(state, "--light needs 2, 3 or 5 numbers with commas, not '%s'", text);
    parse_numbers("light", text, count, number, state);
    if (count < 5)
        number[3] = number[4] = number[2];
    weft_light *light = &scene->light[scene->light_count++];
    *light = (weft_light){{weft_rad_of_deg(number[0]), weft_rad_of_deg(number[1])}, {number[2], number[3], number[4]}};
    for (int c = 0; c < 3; c++)
        if (!(light->irradiance[c] >= 0 && light->irradiance[c] <= 1e9))
            argp_error(state, "--light needs a strength from 0 to 1e9, not '%s'", text);
}

static void apply_environment(scene_options *o, const char *argument, struct argp_state *state)
{
    bool off = strcmp(argument, "off") == 0;
    o->settings.scene.environment = !off;
    set_text(&o->settings.environment, off ? NULL : argument, state);
    /* A map lights everything by itself, unless lights are asked for. */
    if (!off && !o->has_lights && !o->source)
        o->settings.scene.light_count = 0;
}

static bool apply_lighting(scene_options *o, int key, const char *argument, struct argp_state *state)
{
    static const char *const tone_words[] = {"clip", "soft", NULL};
    weft_scene *scene = &o->settings.scene;
    switch (key) {
    case KEY_LIGHT:
        apply_light(o, argument, state);
        return true;
    case KEY_SHADOWS:
        scene->shadows = switch_of("shadows", argument, state);
        return true;
    case KEY_ENVIRONMENT:
        apply_environment(o, argument, state);
        return true;
    case KEY_ENVIRONMENT_TURN:
        scene->environment_turn_rad = weft_rad_of_deg(parse_number("environment-turn", argument, -3600, 3600, state));
        return true;
    case KEY_ENVIRONMENT_STRENGTH:
        scene->environment_strength = parse_number("environment-strength", argument, 0, 1e9, state);
        return true;
    case KEY_ENVIRONMENT_REFERENCE:
        scene->environment_reference = switch_of("environment-reference", argument, state);
        return true;
    case KEY_EXPOSURE:
        scene->exposure = parse_number("exposure", argument, 1e-9, 1e9, state);
        return true;
    case KEY_TONE:
        scene->tone = (weft_tone)parse_word("tone", argument, tone_words, state);
        return true;
    default:
        return false;
    }
}

/* ---- Evaluation ---- */

static void apply_level(weft_scene *scene, const char *text, struct argp_state *state)
{
    if (strcmp(text, "auto") == 0) {
        scene->level_choice = WEFT_LEVEL_TRILINEAR;
    } else if (strcmp(text, "nearest") == 0) {
        scene->level_choice = WEFT_LEVEL_NEAREST;
    } else if (strcmp(text, "none") == 0) {
        scene->level_choice = WEFT_LEVEL_NONE;
    } else {
        scene->level_choice = WEFT_LEVEL_FIXED;
        scene->level = parse_number("level", text, 0, WEFT_MATERIAL_MAX_LEVELS, state);
    }
}

static void take_lobe(scene_options *o, int index, struct argp_state *state)
{
    (void)state;
    if (index < WEFT_SCENE_MAX_LOBES)
        o->settings.scene.lobe[index] = true;
}

static void apply_lobes(scene_options *o, const char *argument, struct argp_state *state)
{
    static const char *const lobe_words[] = {"1", "2", "3", "none", NULL};
    memset(o->settings.scene.lobe, 0, sizeof o->settings.scene.lobe);
    parse_words("lobes-on", argument, lobe_words, o, take_lobe, state);
}

static void take_shown(scene_options *o, int index, struct argp_state *state)
{
    (void)state;
    o->settings.scene.show_level |= index == 0;
    o->settings.scene.show_extrapolation |= index == 1;
}

static void apply_show(scene_options *o, const char *argument, struct argp_state *state)
{
    static const char *const show_words[] = {"level", "extrapolation", "none", NULL};
    o->settings.scene.show_level = o->settings.scene.show_extrapolation = false;
    parse_words("show", argument, show_words, o, take_shown, state);
}

static void apply_tables(weft_scene *scene, const char *argument, struct argp_state *state)
{
    static const char *const table_words[] = {"none", "view", "light", "both", NULL};
    int tables = parse_word("tables", argument, table_words, state);
    scene->view_table = tables & 1;
    scene->light_table = tables & 2;
}

static void apply_evaluation(scene_options *o, int key, const char *argument, struct argp_state *state)
{
    static const char *const filter_words[] = {"auto", "exact", "stochastic", NULL};
    weft_scene *scene = &o->settings.scene;
    switch (key) {
    case KEY_LEVEL:
        apply_level(scene, argument, state);
        break;
    case KEY_FILTER:
        scene->filter = (weft_filter)parse_word("filter", argument, filter_words, state);
        break;
    case KEY_LOBES:
        apply_lobes(o, argument, state);
        break;
    case KEY_TABLES:
        apply_tables(scene, argument, state);
        break;
    case KEY_TABLE_BITS:
        scene->table_bits = (int)parse_whole("table-bits", argument, 1, 8, state);
        break;
    case KEY_NOISE:
        scene->noise_seed = parse_noise_seed("noise", argument, state);
        break;
    case KEY_SHOW:
        apply_show(o, argument, state);
        break;
    default:
        break;
    }
}

void scene_apply(scene_options *o, int key, const char *argument, struct argp_state *state)
{
    if (!apply_shown(o, key, argument, state) && !apply_mesh(o, key, argument, state) &&
        !apply_lighting(o, key, argument, state))
        apply_evaluation(o, key, argument, state);
}
