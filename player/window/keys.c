#include "player/window/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <stdio.h>

static const double turn_step = 5 * WEFT_PI / 180;

#define EXPOSURE_STEP 1.189207115 /* a quarter of a stop */
#define ZOOM_STEP 0.9

/* ---- What is shown ---- */

static void say_missing(weft_interaction *i, weft_mode mode)
{
    static const char *const missing[WEFT_MODE_COUNT] = {
        "no samples: drop a .btf.h5, or give --raw",
        "no material: drop a .weft",
        "no cloth: drop a .wv or .mc, or give --weave",
    };
    if (i->is_reading)
        snprintf(i->message, sizeof i->message, "%s: not read yet", weft_mode_name(mode));
    else
        snprintf(i->message, sizeof i->message, "%s", missing[mode]);
}

static void show(weft_interaction *i, double value)
{
    weft_mode mode = (weft_mode)value;
    if (!i->available[mode]) {
        say_missing(i, mode);
        return;
    }
    weft_interaction_show(i, mode);
    snprintf(i->message, sizeof i->message, "%s", weft_mode_name(mode));
}

static void flip(weft_interaction *i, double value)
{
    (void)value;
    weft_interaction_flip(i);
    const char *first = weft_mode_name(i->scene.pane[0]), *second = weft_mode_name(i->scene.pane[1]);
    if (i->scene.layout == WEFT_LAYOUT_WIPE)
        snprintf(i->message, sizeof i->message, "wipe: %s left, %s right", first, second);
    else if (i->scene.layout == WEFT_LAYOUT_DIFFERENCE)
        snprintf(i->message, sizeof i->message, "difference: %s minus %s", second, first);
    else if (i->scene.pane_count == 1)
        snprintf(i->message, sizeof i->message, "%s", first);
}

static void peek(weft_interaction *i, double value)
{
    (void)value;
    if (i->available[WEFT_MODE_RAW])
        weft_interaction_peek(i);
    else
        say_missing(i, WEFT_MODE_RAW);
}

static void lay_out(weft_interaction *i, double value)
{
    weft_layout layout = (weft_layout)value;
    static const char *const said[WEFT_LAYOUT_COUNT] = {"side by side", "wipe", "difference: second minus first"};
    weft_interaction_lay_out(i, layout);
    if (weft_scene_panes(&i->scene) > 1)
        snprintf(i->message, sizeof i->message, "%s", said[layout]);
    else
        snprintf(i->message, sizeof i->message, "nothing to compare with: drop another file of this cloth");
}

/* ---- How it is shown ---- */

static void next_level_choice(weft_interaction *i, double value)
{
    (void)value;
    static const char *const name[] = {"trilinear", "nearest", "none"};
    weft_scene *scene = &i->scene;
    scene->level_choice = scene->level_choice < WEFT_LEVEL_NONE ? scene->level_choice + 1 : WEFT_LEVEL_TRILINEAR;
    snprintf(i->message, sizeof i->message, "mip levels: %s", name[scene->level_choice]);
    i->changed = true;
}

static void toggle(weft_interaction *i, bool *value, const char *name)
{
    *value = !*value;
    snprintf(i->message, sizeof i->message, "%s: %s", name, *value ? "on" : "off");
    i->changed = true;
}

static void toggle_levels(weft_interaction *i, double value)
{
    (void)value;
    toggle(i, &i->scene.show_level, "level in false colour");
}

static void toggle_extrapolation(weft_interaction *i, double value)
{
    (void)value;
    toggle(i, &i->scene.show_extrapolation, "tint where nothing was measured");
}

static void toggle_shadows(weft_interaction *i, double value)
{
    (void)value;
    if (i->scene.light_count > 0)
        toggle(i, &i->scene.shadows, "shadows");
    else
        snprintf(i->message, sizeof i->message, "no shadows without a key light");
}

static void toggle_relief(weft_interaction *i, double value)
{
    (void)value;
    if (i->has_relief)
        toggle(i, &i->scene.relief, "through the heights");
    else
        snprintf(i->message, sizeof i->message,
                 "no heights: weft relief finds those of a dataset, weft compress keeps them");
}

static void toggle_environment(weft_interaction *i, double value)
{
    (void)value;
    if (!i->has_environment) {
        snprintf(i->message, sizeof i->message, "no environment: drop an .exr or .hdr, or give --environment");
        return;
    }
    toggle(i, &i->scene.environment, "environment");
    weft_scene_keep_lit(&i->scene);
}

static void expose(weft_interaction *i, double factor)
{
    i->scene.exposure *= factor;
    snprintf(i->message, sizeof i->message, "exposure %.2f", i->scene.exposure);
    i->changed = true;
}

/* ---- Camera, light and mesh ---- */

static void turn_across(weft_interaction *i, double steps)
{
    weft_interaction_turn(i, steps * turn_step, 0);
}

static void turn_down(weft_interaction *i, double steps)
{
    weft_interaction_turn(i, 0, steps * turn_step);
}

static void zoom(weft_interaction *i, double factor)
{
    weft_orbit_zoom(&i->scene.orbit, factor);
    i->changed = true;
}

static void hold_light(weft_interaction *i, double value)
{
    (void)value;
    i->drag_moves_light = !i->drag_moves_light;
    snprintf(i->message, sizeof i->message, "%s", i->drag_moves_light ? "the light moves" : "the cloth turns");
}

static void turn_by_itself(weft_interaction *i, double value)
{
    (void)value;
    i->turns = !i->turns;
    snprintf(i->message, sizeof i->message, "turn by itself: %s", i->turns ? "on" : "off");
}

static void see_all(weft_interaction *i, double value)
{
    (void)value;
    weft_orbit *orbit = &i->scene.orbit;
    *orbit = (weft_orbit){orbit->azimuth_rad, orbit->elevation_rad, weft_orbit_whole(), 0, 0};
    snprintf(i->message, sizeof i->message, "all of it");
    i->changed = true;
}

static void look_from_start(weft_interaction *i, double value)
{
    (void)value;
    i->scene.orbit = i->start.orbit;
    snprintf(i->message, sizeof i->message, "camera as at the start");
    i->changed = true;
}

static void light_from_start(weft_interaction *i, double value)
{
    (void)value;
    weft_scene *scene = &i->scene;
    for (int l = 0; l < WEFT_SCENE_MAX_LIGHTS; l++)
        scene->light[l] = i->start.light[l];
    scene->light_count = i->start.light_count;
    scene->environment_turn_rad = i->start.environment_turn_rad;
    scene->environment_strength = i->start.environment_strength;
    scene->exposure = i->start.exposure;
    weft_scene_keep_lit(scene);
    snprintf(i->message, sizeof i->message, "lights and exposure as at the start");
    i->changed = true;
}

static void choose_mesh(weft_interaction *i, double value)
{
    static const char *const mesh[] = {"drape", "sphere", "plane"}, *const said[] = {"drape", "ball", "plane"};
    i->wants_mesh = mesh[(int)value];
    snprintf(i->message, sizeof i->message, "%s", said[(int)value]);
}

/* ---- Files and window ---- */

static void leave(weft_interaction *i, double value)
{
    (void)value;
    if (i->shows_help)
        i->shows_help = false;
    else if (i->full_screen)
        i->full_screen = false;
    else
        i->wants_quit = true;
}

/* ---- The table ---- */

#define AT(member) offsetof(weft_interaction, member)

static const weft_key keys[] = {
    {.name = "Mouse"},
    {.name = "drag", .meaning = "turn"},
    {.name = "right drag, Shift + drag", .meaning = "move the light"},
    {.name = "middle drag, Ctrl + drag", .meaning = "shift"},
    {.name = "wheel", .meaning = "closer, farther"},
    {.name = "drop a file", .meaning = "show it in place of the one of its kind"},
    {.name = "SpaceMouse", .meaning = "turn, shift, closer, farther"},
    {.name = "What is shown"},
    {"1", "raw samples", GLFW_KEY_1, .press = show, .value = WEFT_MODE_RAW},
    {"2", "compressed", GLFW_KEY_2, .press = show, .value = WEFT_MODE_COMPRESSED},
    {"3", "analytic", GLFW_KEY_3, .press = show, .value = WEFT_MODE_ANALYTIC},
    {"Space", "back to the one before", GLFW_KEY_SPACE, .press = flip},
    {"B, held", "raw, until it is released", GLFW_KEY_B, .press = peek, .release = weft_interaction_end_peek},
    {"S", "side by side", GLFW_KEY_S, .press = lay_out, .value = WEFT_LAYOUT_PANES},
    {"W", "wipe: drag the line", GLFW_KEY_W, .press = lay_out, .value = WEFT_LAYOUT_WIPE},
    {"X", "difference: second minus first", GLFW_KEY_X, .press = lay_out, .value = WEFT_LAYOUT_DIFFERENCE},
    {"N", "mip level in false colour", GLFW_KEY_N, .press = toggle_levels},
    {"T", "tint where nothing was measured", GLFW_KEY_T, .press = toggle_extrapolation},
    {"M", "mip levels: trilinear, nearest, none", GLFW_KEY_M, .press = next_level_choice},
    {"Z", "raw and components through heights", GLFW_KEY_Z, .press = toggle_relief},
    {.name = "Camera and light"},
    {"arrows", "turn", GLFW_KEY_LEFT, .repeats = true, .press = turn_across, .value = -1},
    {NULL, NULL, GLFW_KEY_RIGHT, .repeats = true, .press = turn_across, .value = 1},
    {NULL, NULL, GLFW_KEY_UP, .repeats = true, .press = turn_down, .value = -1},
    {NULL, NULL, GLFW_KEY_DOWN, .repeats = true, .press = turn_down, .value = 1},
    {"+ -", "closer, farther", GLFW_KEY_EQUAL, .repeats = true, .press = zoom, .value = ZOOM_STEP},
    {NULL, NULL, GLFW_KEY_KP_ADD, .repeats = true, .press = zoom, .value = ZOOM_STEP},
    {NULL, NULL, GLFW_KEY_MINUS, .repeats = true, .press = zoom, .value = 1 / ZOOM_STEP},
    {NULL, NULL, GLFW_KEY_KP_SUBTRACT, .repeats = true, .press = zoom, .value = 1 / ZOOM_STEP},
    {"L", "plain drags and arrows move the light", GLFW_KEY_L, .press = hold_light},
    {"A", "turn by itself", GLFW_KEY_A, .press = turn_by_itself},
    {"F", "all of it in the picture", GLFW_KEY_F, .press = see_all},
    {"Home", "camera as at the start", GLFW_KEY_HOME, .press = look_from_start},
    {"0", "lights and exposure as at the start", GLFW_KEY_0, .press = light_from_start},
    {"[", "darker", GLFW_KEY_LEFT_BRACKET, .repeats = true, .press = expose, .value = 1 / EXPOSURE_STEP},
    {"]", "brighter", GLFW_KEY_RIGHT_BRACKET, .repeats = true, .press = expose, .value = EXPOSURE_STEP},
    {"C", "shadows", GLFW_KEY_C, .press = toggle_shadows},
    {"E", "environment", GLFW_KEY_E, .press = toggle_environment},
    {"D", "drape", GLFW_KEY_D, .press = choose_mesh, .value = 0},
    {"O", "ball", GLFW_KEY_O, .press = choose_mesh, .value = 1},
    {"P", "plane", GLFW_KEY_P, .press = choose_mesh, .value = 2},
    {.name = "Window"},
    {"F12, Ctrl + S", "save the picture", GLFW_KEY_F12, .sets = AT(wants_screenshot)},
    {NULL, NULL, GLFW_KEY_S, .with_control = true, .sets = AT(wants_screenshot)},
    {"Ctrl + Z", "undo: light, weave, what is shown", GLFW_KEY_Z, .with_control = true, .sets = AT(wants_undo)},
    {"Ctrl + Y", "do it again", GLFW_KEY_Y, .with_control = true, .sets = AT(wants_redo)},
    {"R", "read the files again", GLFW_KEY_R, .sets = AT(wants_reload)},
    {"F11", "full screen", GLFW_KEY_F11, .toggles = AT(full_screen)},
    {"Tab", "panel", GLFW_KEY_TAB, .toggles = AT(shows_panel)},
    {"H, F1", "this list", GLFW_KEY_H, .toggles = AT(shows_help)},
    {NULL, NULL, GLFW_KEY_F1, .toggles = AT(shows_help)},
    {"Esc", "close this list, leave full screen, quit", GLFW_KEY_ESCAPE, .press = leave},
    {"Q, Ctrl + Q", "quit", GLFW_KEY_Q, .sets = AT(wants_quit)},
    {NULL, NULL, GLFW_KEY_Q, .with_control = true, .sets = AT(wants_quit)},
};

const weft_key *weft_keys(size_t *count)
{
    *count = sizeof keys / sizeof *keys;
    return keys;
}

static bool *switch_at(weft_interaction *i, size_t offset)
{
    return (bool *)((char *)i + offset);
}

static void press(weft_interaction *i, const weft_key *key)
{
    if (key->press)
        key->press(i, key->value);
    if (key->sets)
        *switch_at(i, key->sets) = true;
    if (key->toggles)
        *switch_at(i, key->toggles) = !*switch_at(i, key->toggles);
}

void weft_keys_press(weft_interaction *i, int code, int modifiers, bool again)
{
    bool control = modifiers & GLFW_MOD_CONTROL;
    if (modifiers & (GLFW_MOD_ALT | GLFW_MOD_SUPER))
        return;
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
        if (keys[k].code == code && keys[k].with_control == control && (!again || keys[k].repeats))
            press(i, &keys[k]);
    }
}

void weft_keys_release(weft_interaction *i, int code)
{
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
        if (keys[k].code == code && keys[k].release)
            keys[k].release(i);
    }
}
