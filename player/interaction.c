#include "player/interaction.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <stddef.h>

static const double lowest_light_rad = 110 * WEFT_PI / 180;
static const double zoom_step = 0.9, exposure_step = 1.189207115; /* a quarter of a stop */
static const double divider_reach = 8;                            /* pixels */

/* ---- Mouse ---- */

static bool is_on_divider(const weft_interaction *i, double x)
{
    return i->scene.layout == WEFT_LAYOUT_WIPE && fabs(x - i->scene.divider * i->width) < divider_reach;
}

static weft_drag drag_of(const weft_interaction *i, int button, int modifiers)
{
    if (button == GLFW_MOUSE_BUTTON_MIDDLE || (button == GLFW_MOUSE_BUTTON_LEFT && modifiers & GLFW_MOD_CONTROL))
        return WEFT_DRAG_PAN;
    if (button == GLFW_MOUSE_BUTTON_RIGHT)
        return WEFT_DRAG_LIGHT;
    if (button != GLFW_MOUSE_BUTTON_LEFT)
        return WEFT_DRAG_NONE;
    if (is_on_divider(i, i->x))
        return WEFT_DRAG_DIVIDER;
    return modifiers & GLFW_MOD_SHIFT || i->drag_moves_light ? WEFT_DRAG_LIGHT : WEFT_DRAG_ORBIT;
}

void weft_interaction_press(weft_interaction *i, int button, bool pressed, int modifiers, double x, double y)
{
    i->x = x;
    i->y = y;
    i->drag = pressed ? drag_of(i, button, modifiers) : WEFT_DRAG_NONE;
}

/* What is under the pointer stays there, for what lies at the distance of the centre. */
static void pan(weft_interaction *i, double x, double y)
{
    weft_orbit *orbit = &i->scene.orbit;
    int smaller = i->width < i->height ? i->width : i->height;
    double radii = smaller > 0 ? 2 * weft_orbit_slope() * orbit->distance / smaller : 0;
    weft_orbit_pan(orbit, -radii * x, radii * y);
}

void weft_interaction_turn_light(weft_angles *light, double phi_rad, double theta_rad)
{
    light->phi_rad = fmod(light->phi_rad + phi_rad, 2 * WEFT_PI);
    light->theta_rad = weft_clamp(light->theta_rad + theta_rad, 0, lowest_light_rad);
}

void weft_interaction_move(weft_interaction *i, double x, double y)
{
    double across = (x - i->x) / (i->width > 0 ? i->width : 1), down = (y - i->y) / (i->height > 0 ? i->height : 1);
    switch (i->drag) {
    case WEFT_DRAG_ORBIT:
        weft_orbit_turn(&i->scene.orbit, -across * 2 * WEFT_PI, down * WEFT_PI);
        break;
    case WEFT_DRAG_PAN:
        pan(i, x - i->x, y - i->y);
        break;
    case WEFT_DRAG_LIGHT:
        weft_interaction_turn_light(&i->scene.light[0].direction, across * 2 * WEFT_PI, down * WEFT_PI);
        break;
    case WEFT_DRAG_DIVIDER:
        i->scene.divider = weft_clamp(i->scene.divider + across, 0.01, 0.99);
        break;
    default:
        break;
    }
    i->x = x;
    i->y = y;
    i->changed |= i->drag != WEFT_DRAG_NONE;
}

void weft_interaction_scroll(weft_interaction *i, double steps)
{
    weft_orbit_zoom(&i->scene.orbit, pow(zoom_step, steps));
    i->changed = true;
}

/* ---- Modes and layouts ---- */

void weft_interaction_show(weft_interaction *i, weft_mode mode)
{
    if (!i->available[mode])
        return;
    if (i->scene.pane[0] != mode)
        i->before = i->scene.pane[0];
    i->scene.layout = WEFT_LAYOUT_PANES;
    i->scene.pane_count = 1;
    i->scene.pane[0] = mode;
    i->changed = true;
}

void weft_interaction_lay_out(weft_interaction *i, weft_layout layout)
{
    weft_scene *scene = &i->scene;
    int count = 0;
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++) {
        if (i->available[mode])
            scene->pane[count++] = (weft_mode)mode;
    }
    scene->pane_count = count;
    scene->layout = count > 1 ? layout : WEFT_LAYOUT_PANES;
    i->changed = true;
}

/* ---- Keys ---- */

static void show_raw(weft_interaction *i)
{
    weft_interaction_show(i, WEFT_MODE_RAW);
}

static void show_compressed(weft_interaction *i)
{
    weft_interaction_show(i, WEFT_MODE_COMPRESSED);
}

static void show_analytic(weft_interaction *i)
{
    weft_interaction_show(i, WEFT_MODE_ANALYTIC);
}

static void flip(weft_interaction *i)
{
    if (i->scene.layout != WEFT_LAYOUT_PANES) {
        weft_mode first = i->scene.pane[0];
        i->scene.pane[0] = i->scene.pane[1];
        i->scene.pane[1] = first;
        i->changed = true;
    } else {
        weft_interaction_show(i, i->before);
    }
}

static void show_all(weft_interaction *i)
{
    weft_interaction_lay_out(i, WEFT_LAYOUT_PANES);
}

static void wipe(weft_interaction *i)
{
    weft_interaction_lay_out(i, WEFT_LAYOUT_WIPE);
}

static void subtract(weft_interaction *i)
{
    weft_interaction_lay_out(i, WEFT_LAYOUT_DIFFERENCE);
}

static void next_level_choice(weft_interaction *i)
{
    weft_scene *scene = &i->scene;
    scene->level_choice = scene->level_choice < WEFT_LEVEL_NONE ? scene->level_choice + 1 : WEFT_LEVEL_TRILINEAR;
    i->changed = true;
}

static void toggle(weft_interaction *i, bool *value)
{
    *value = !*value;
    i->changed = true;
}

static void toggle_levels(weft_interaction *i)
{
    toggle(i, &i->scene.show_level);
}

static void toggle_extrapolation(weft_interaction *i)
{
    toggle(i, &i->scene.show_extrapolation);
}

static void toggle_shadows(weft_interaction *i)
{
    toggle(i, &i->scene.shadows);
}

static void toggle_environment(weft_interaction *i)
{
    toggle(i, &i->scene.environment);
}

static void darken(weft_interaction *i)
{
    i->scene.exposure /= exposure_step;
    i->changed = true;
}

static void brighten(weft_interaction *i)
{
    i->scene.exposure *= exposure_step;
    i->changed = true;
}

static void hold_light(weft_interaction *i)
{
    i->drag_moves_light = !i->drag_moves_light;
}

static void look_from_start(weft_interaction *i)
{
    i->scene.orbit = weft_scene_default().orbit;
    i->changed = true;
}

static void want_drape(weft_interaction *i)
{
    i->wants_mesh = "drape";
}

static void want_sphere(weft_interaction *i)
{
    i->wants_mesh = "sphere";
}

static void want_plane(weft_interaction *i)
{
    i->wants_mesh = "plane";
}

static void want_screenshot(weft_interaction *i)
{
    i->wants_screenshot = true;
}

static void want_reload(weft_interaction *i)
{
    i->wants_reload = true;
}

static void want_quit(weft_interaction *i)
{
    i->wants_quit = true;
}

static void toggle_panel(weft_interaction *i)
{
    i->shows_panel = !i->shows_panel;
}

static void toggle_help(weft_interaction *i)
{
    i->shows_help = !i->shows_help;
}

static const struct {
    int key;
    void (*act)(weft_interaction *);
} actions[] = {
    {GLFW_KEY_1, show_raw},          {GLFW_KEY_2, show_compressed},
    {GLFW_KEY_3, show_analytic},     {GLFW_KEY_SPACE, flip},
    {GLFW_KEY_S, show_all},          {GLFW_KEY_W, wipe},
    {GLFW_KEY_X, subtract},          {GLFW_KEY_M, next_level_choice},
    {GLFW_KEY_N, toggle_levels},     {GLFW_KEY_T, toggle_extrapolation},
    {GLFW_KEY_C, toggle_shadows},    {GLFW_KEY_E, toggle_environment},
    {GLFW_KEY_LEFT_BRACKET, darken}, {GLFW_KEY_RIGHT_BRACKET, brighten},
    {GLFW_KEY_L, hold_light},        {GLFW_KEY_HOME, look_from_start},
    {GLFW_KEY_D, want_drape},        {GLFW_KEY_O, want_sphere},
    {GLFW_KEY_P, want_plane},        {GLFW_KEY_R, want_reload},
    {GLFW_KEY_F12, want_screenshot}, {GLFW_KEY_TAB, toggle_panel},
    {GLFW_KEY_H, toggle_help},       {GLFW_KEY_Q, want_quit},
    {GLFW_KEY_ESCAPE, want_quit},
};

/* In the order of the actions. */
static const weft_interaction_line lines[] = {
    {"drag", "turn"},
    {"middle drag, Ctrl + drag", "shift"},
    {"right drag, Shift + drag", "move the light"},
    {"wheel", "closer, farther"},
    {"1  2  3", "raw, compressed, analytic"},
    {"Space", "flip to the one before"},
    {"S  W  X", "side by side, wipe, difference"},
    {"M", "mip levels: trilinear, nearest, none"},
    {"N  T", "show the level, tint what was not measured"},
    {"C  E", "shadows, environment"},
    {"[  ]", "darker, brighter"},
    {"L", "a plain drag moves the light"},
    {"Home", "look from the start"},
    {"D  O  P", "drape, ball, plane"},
    {"R", "read the files again"},
    {"drop a file", "show it instead of the one of its kind"},
    {"SpaceMouse", "turn, shift, closer and farther"},
    {"F12", "save the picture"},
    {"Tab", "panel"},
    {"H", "this list"},
    {"Q", "quit"},
    {NULL, NULL},
};

const weft_interaction_line *weft_interaction_help(void)
{
    return lines;
}

void weft_interaction_key(weft_interaction *i, int key)
{
    for (size_t k = 0; k < sizeof actions / sizeof *actions; k++) {
        if (actions[k].key == key)
            actions[k].act(i);
    }
}
