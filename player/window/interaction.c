#include "player/window/interaction.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

static const double lowest_light_rad = 110 * WEFT_PI / 180;
static const double zoom_step = 0.9;
static const double ball_share = 0.9, rim_rad = 85 * WEFT_PI / 180; /* of the map of lights */
static const double divider_reach = 8;                              /* pixels */

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
    if (modifiers & GLFW_MOD_SHIFT || !i->drag_moves_light)
        return modifiers & GLFW_MOD_SHIFT ? WEFT_DRAG_LIGHT : WEFT_DRAG_ORBIT;
    return i->points_light && i->scene.light_count > 0 ? WEFT_DRAG_POINT : WEFT_DRAG_LIGHT;
}

/* theta is limited to what a light may have. */
static void turn_light(weft_angles *light, double phi_rad, double theta_rad)
{
    light->phi_rad = fmod(light->phi_rad + phi_rad, 2 * WEFT_PI);
    light->theta_rad = weft_clamp(light->theta_rad + theta_rad, 0, lowest_light_rad);
}

/* The key light stands where the pointer is on a ball that nearly fills the picture, at its rim where it is beyond. */
static void point_light(weft_interaction *i)
{
    double radius = ball_share * 0.5 * (i->width < i->height ? i->width : i->height);
    double right = (i->x - 0.5 * i->width) / radius, up = (0.5 * i->height - i->y) / radius;
    double shrink = fmin(1, sin(rim_rad) / fmax(hypot(right, up), 1e-9));
    weft_orbit_axes axes = weft_orbit_axes_of(&i->scene.orbit);
    weft_vec3 light = weft_add(weft_scale(axes.right, shrink * right), weft_scale(axes.up, shrink * up));
    light = weft_add(light, weft_scale(axes.backward, sqrt(1 - weft_dot(light, light))));
    i->scene.light[0].direction = weft_angles_of_direction(light);
    turn_light(&i->scene.light[0].direction, 0, 0);
    i->changed = true;
}

void weft_interaction_press(weft_interaction *i, int button, bool pressed, int modifiers, double x, double y)
{
    i->x = x;
    i->y = y;
    i->drag = pressed ? drag_of(i, button, modifiers) : WEFT_DRAG_NONE;
    if (i->drag == WEFT_DRAG_POINT)
        point_light(i);
}

/* What is under the pointer stays there, for what lies at the distance of the centre. */
static void pan(weft_interaction *i, double x, double y)
{
    weft_orbit *orbit = &i->scene.orbit;
    int smaller = i->width < i->height ? i->width : i->height;
    double radii = smaller > 0 ? 2 * weft_orbit_slope() * orbit->distance / smaller : 0;
    weft_orbit_pan(orbit, -radii * x, radii * y);
}

/* The key light, or the environment where that is the only one. */
static void move_light(weft_interaction *i, double phi_rad, double theta_rad)
{
    weft_scene *scene = &i->scene;
    if (scene->light_count > 0)
        turn_light(&scene->light[0].direction, phi_rad, theta_rad);
    else
        scene->environment_turn_rad = remainder(scene->environment_turn_rad + phi_rad, 2 * WEFT_PI);
}

void weft_interaction_turn(weft_interaction *i, double across_rad, double down_rad)
{
    if (i->drag_moves_light)
        move_light(i, across_rad, down_rad);
    else
        weft_orbit_turn(&i->scene.orbit, -across_rad, down_rad);
    i->changed = true;
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
        move_light(i, across * 2 * WEFT_PI, down * WEFT_PI);
        break;
    case WEFT_DRAG_DIVIDER:
        i->scene.divider = weft_clamp(i->scene.divider + across, 0.01, 0.99);
        break;
    default:
        break;
    }
    i->x = x;
    i->y = y;
    if (i->drag == WEFT_DRAG_POINT)
        point_light(i);
    i->changed |= i->drag != WEFT_DRAG_NONE;
}

void weft_interaction_scroll(weft_interaction *i, double steps)
{
    weft_orbit_zoom(&i->scene.orbit, pow(zoom_step, steps));
    i->changed = true;
}

/* ---- Modes and layouts ---- */

static void show_alone(weft_interaction *i, weft_mode mode)
{
    i->scene.layout = WEFT_LAYOUT_PANES;
    i->scene.pane_count = 1;
    i->scene.pane[0] = mode;
    i->changed = true;
}

void weft_interaction_show(weft_interaction *i, weft_mode mode)
{
    if (!i->available[mode])
        return;
    weft_interaction_end_peek(i);
    if (i->scene.pane[0] != mode)
        i->before = i->scene.pane[0];
    show_alone(i, mode);
}

void weft_interaction_lay_out(weft_interaction *i, weft_layout layout)
{
    weft_scene *scene = &i->scene;
    int count = 0;
    weft_interaction_end_peek(i);
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++) {
        if (i->available[mode])
            scene->pane[count++] = (weft_mode)mode;
    }
    scene->pane_count = count;
    scene->layout = count > 1 ? layout : WEFT_LAYOUT_PANES;
    i->changed = true;
}

/* Before anything was flipped: another mode there is. */
static weft_mode mode_before(const weft_interaction *i)
{
    weft_mode shown = i->scene.pane[0];
    if (i->before != shown && i->available[i->before])
        return i->before;
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++) {
        if (i->available[mode] && (weft_mode)mode != shown)
            return (weft_mode)mode;
    }
    return shown;
}

void weft_interaction_flip(weft_interaction *i)
{
    weft_interaction_end_peek(i);
    if (i->scene.layout != WEFT_LAYOUT_PANES) {
        weft_mode first = i->scene.pane[0];
        i->scene.pane[0] = i->scene.pane[1];
        i->scene.pane[1] = first;
        i->changed = true;
    } else {
        weft_interaction_show(i, mode_before(i));
    }
}

void weft_interaction_peek(weft_interaction *i)
{
    const weft_scene *scene = &i->scene;
    bool shows_raw = scene->layout == WEFT_LAYOUT_PANES && scene->pane_count == 1 && scene->pane[0] == WEFT_MODE_RAW;
    if (i->peeks || shows_raw || !i->available[WEFT_MODE_RAW])
        return;
    i->peeks = true;
    i->unpeeked = *scene;
    show_alone(i, WEFT_MODE_RAW);
}

void weft_interaction_end_peek(weft_interaction *i)
{
    weft_scene *scene = &i->scene;
    if (!i->peeks)
        return;
    i->peeks = false;
    i->changed = true;
    scene->layout = i->unpeeked.layout;
    scene->pane_count = i->unpeeked.pane_count;
    for (int pane = 0; pane < WEFT_MODE_COUNT; pane++)
        scene->pane[pane] = i->unpeeked.pane[pane];
}
