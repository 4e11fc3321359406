#include "player/interaction.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <stddef.h>

const char weft_interaction_help[] = "drag          turn\n"
                                     "right drag    move the light (also shift, or L)\n"
                                     "wheel         closer, farther\n"
                                     "1 2 3         raw, compressed, analytic\n"
                                     "S             side by side\n"
                                     "M             mip levels on, off\n"
                                     "[ ]           darker, brighter\n"
                                     "D O P         drape, ball, plane\n"
                                     "F12           save the picture\n"
                                     "H             this text\n"
                                     "Q             quit";

static const double highest_elevation_rad = 89.9 * WEFT_PI / 180;
static const double lowest_light_rad = 110 * WEFT_PI / 180;
static const double nearest_distance = 1.05, farthest_distance = 60;
static const double zoom_step = 0.9, exposure_step = 1.189207115; /* a quarter of a stop */

void weft_interaction_press(weft_interaction *i, int button, bool pressed, bool shift, double x, double y)
{
    i->x = x;
    i->y = y;
    i->drag = WEFT_DRAG_NONE;
    if (!pressed)
        return;
    if (button == GLFW_MOUSE_BUTTON_RIGHT || (button == GLFW_MOUSE_BUTTON_LEFT && (shift || i->drag_moves_light)))
        i->drag = WEFT_DRAG_LIGHT;
    else if (button == GLFW_MOUSE_BUTTON_LEFT)
        i->drag = WEFT_DRAG_ORBIT;
}

static void turn_camera(weft_orbit *orbit, double azimuth_rad, double elevation_rad)
{
    orbit->azimuth_rad = fmod(orbit->azimuth_rad - azimuth_rad, 2 * WEFT_PI);
    orbit->elevation_rad =
        weft_clamp(orbit->elevation_rad + elevation_rad, -highest_elevation_rad, highest_elevation_rad);
}

static void turn_light(weft_angles *light, double phi_rad, double theta_rad)
{
    light->phi_rad = fmod(light->phi_rad + phi_rad, 2 * WEFT_PI);
    light->theta_rad = weft_clamp(light->theta_rad + theta_rad, 0, lowest_light_rad);
}

void weft_interaction_move(weft_interaction *i, double x, double y)
{
    double across_rad = (x - i->x) / (i->width > 0 ? i->width : 1) * 2 * WEFT_PI;
    double down_rad = (y - i->y) / (i->height > 0 ? i->height : 1) * WEFT_PI;
    i->x = x;
    i->y = y;
    if (i->drag == WEFT_DRAG_ORBIT)
        turn_camera(&i->scene.orbit, across_rad, down_rad);
    else if (i->drag == WEFT_DRAG_LIGHT)
        turn_light(&i->scene.light[0].direction, across_rad, down_rad);
    i->changed |= i->drag != WEFT_DRAG_NONE;
}

void weft_interaction_scroll(weft_interaction *i, double steps)
{
    i->scene.orbit.distance =
        weft_clamp(i->scene.orbit.distance * pow(zoom_step, steps), nearest_distance, farthest_distance);
    i->changed = true;
}

static void show_one(weft_interaction *i, weft_mode mode)
{
    if (!i->available[mode])
        return;
    i->scene.pane_count = 1;
    i->scene.pane[0] = mode;
}

static void show_all(weft_interaction *i)
{
    i->scene.pane_count = 0;
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++) {
        if (i->available[mode])
            i->scene.pane[i->scene.pane_count++] = (weft_mode)mode;
    }
}

/* Keys that change the picture; false for others. */
static bool change_scene(weft_interaction *i, int key)
{
    weft_scene *scene = &i->scene;
    switch (key) {
    case GLFW_KEY_1:
    case GLFW_KEY_2:
    case GLFW_KEY_3:
        show_one(i, (weft_mode)(key - GLFW_KEY_1));
        return true;
    case GLFW_KEY_S:
        show_all(i);
        return true;
    case GLFW_KEY_M:
        scene->level_choice = scene->level_choice == WEFT_LEVEL_NONE ? WEFT_LEVEL_TRILINEAR : WEFT_LEVEL_NONE;
        return true;
    case GLFW_KEY_LEFT_BRACKET:
        scene->exposure /= exposure_step;
        return true;
    case GLFW_KEY_RIGHT_BRACKET:
        scene->exposure *= exposure_step;
        return true;
    case GLFW_KEY_H:
        scene->help = scene->help ? NULL : weft_interaction_help;
        return true;
    default:
        return false;
    }
}

void weft_interaction_key(weft_interaction *i, int key)
{
    if (change_scene(i, key)) {
        i->changed = true;
        return;
    }
    switch (key) {
    case GLFW_KEY_D:
        i->wants_mesh = "drape";
        break;
    case GLFW_KEY_O:
        i->wants_mesh = "sphere";
        break;
    case GLFW_KEY_P:
        i->wants_mesh = "plane";
        break;
    case GLFW_KEY_L:
        i->drag_moves_light = !i->drag_moves_light;
        break;
    case GLFW_KEY_F12:
        i->wants_screenshot = true;
        break;
    case GLFW_KEY_Q:
    case GLFW_KEY_ESCAPE:
        i->wants_quit = true;
        break;
    default:
        break;
    }
}
