#include "player/window/panel.h"

#include "player/scene/surroundings.h"
#include "player/window/ui/ui_bridge.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 330, NARROWEST_PICTURE = 420 };

static const uint32_t ink = 0xe6e6e3ff, faint = 0xffffff40, ground = 0xffffff10, accent = 0xdb784dff;

int weft_panel_width(const weft_application *a)
{
    int width, height;
    weft_window_size(a->window, &width, &height);
    bool fits = width >= (WIDTH + NARROWEST_PICTURE) * a->scale;
    return a->interaction.shows_panel && fits ? (int)(WIDTH * a->scale) : 0;
}

/* ---- View ---- */

static void mode_row(weft_interaction *i)
{
    static const char *const name[] = {"Raw", "Compressed", "Analytic"};
    bool alone = i->scene.layout == WEFT_LAYOUT_PANES && i->scene.pane_count == 1;
    int mode = alone ? (int)i->scene.pane[0] : -1;
    if (weft_ui_choice("Show", &mode, name, i->available, WEFT_MODE_COUNT))
        weft_interaction_show(i, (weft_mode)mode);
}

static void layout_row(weft_interaction *i)
{
    static const char *const name[] = {"Panes", "Wipe", "Difference"};
    bool several = i->available[0] + i->available[1] + i->available[2] > 1;
    bool alone = i->scene.layout == WEFT_LAYOUT_PANES && i->scene.pane_count == 1;
    const bool allowed[] = {several, several, several};
    int layout = alone ? -1 : (int)i->scene.layout;
    if (weft_ui_choice("Compare", &layout, name, allowed, WEFT_LAYOUT_COUNT))
        weft_interaction_lay_out(i, (weft_layout)layout);
}

/* Which two, where two are compared. */
static void pair_rows(weft_interaction *i)
{
    static const char *const name[] = {"Raw", "Compressed", "Analytic"}, *const label[] = {"First", "Second"};
    for (int pane = 0; i->scene.layout != WEFT_LAYOUT_PANES && pane < 2; pane++) {
        int mode = (int)i->scene.pane[pane];
        if (weft_ui_choice(label[pane], &mode, name, i->available, WEFT_MODE_COUNT)) {
            i->scene.pane[pane] = (weft_mode)mode;
            i->changed = true;
        }
    }
}

static void view_section(weft_interaction *i)
{
    mode_row(i);
    layout_row(i);
    pair_rows(i);
}

/* ---- Light ---- */

static void drag_on_map(weft_light *light, const weft_ui_area *area, double radius)
{
    double x = (area->pointer_x - area->x - radius) / radius, y = (area->y + radius - area->pointer_y) / radius;
    double r = fmin(hypot(x, y), 1);
    light->direction = (weft_angles){acos(1 - r * r), atan2(y, x)};
}

static void draw_ring(const weft_ui_area *area, double radius, double theta_rad, uint32_t colour, double scale)
{
    weft_ui_ring(area->x + radius, area->y + radius, radius * sqrt(1 - cos(theta_rad)), scale, colour);
}

/* The directions of the lights and of the eye above the table; the last measured ring in the accent's colour. */
static void direction_map(weft_application *a)
{
    weft_interaction *i = &a->interaction;
    double radius = 58 * a->scale, view_rad, light_rad, x, y;
    weft_ui_area area = weft_ui_drawing("directions", 2 * radius, 2 * radius);
    if (area.dragged && i->scene.light_count > 0) {
        drag_on_map(&i->scene.light[0], &area, radius);
        i->changed = true;
    }
    weft_player_last_ring(a->player, i->scene.pane[0], &view_rad, &light_rad);
    weft_ui_disc(area.x + radius, area.y + radius, radius, ground);
    for (int ring = 1; ring <= 5; ring++)
        draw_ring(&area, radius, weft_rad_of_deg(15 * ring), 0xffffff18, a->scale);
    draw_ring(&area, radius, light_rad, accent & 0xffffff90, a->scale);
    weft_ui_ring(area.x + radius, area.y + radius, radius, a->scale, faint);
    weft_panel_place(weft_orbit_axes_of(&i->scene.orbit).backward, area.x, area.y, radius, &x, &y);
    weft_ui_ring(x, y, 4 * a->scale, 1.5 * a->scale, ink);
    for (int l = 0; l < i->scene.light_count; l++) {
        weft_panel_place(weft_direction_of_angles(i->scene.light[l].direction), area.x, area.y, radius, &x, &y);
        weft_ui_disc(x, y, (l == 0 ? 5 : 3.5) * a->scale, 0xffd27fff);
    }
}

static void map_legend(const weft_application *a)
{
    double view_rad, light_rad;
    char text[160];
    weft_player_last_ring(a->player, a->interaction.scene.pane[0], &view_rad, &light_rad);
    int used = snprintf(text, sizeof text, "Drag the light.\nDot: light\nCircle: eye");
    if (light_rad < weft_rad_of_deg(89.9)) /* else nothing was measured, or all */
        snprintf(text + used, sizeof text - (size_t)used, "\nRing: last measured,\n%.0f\xc2\xb0",
                 weft_deg_of_rad(light_rad));
    weft_ui_dim_text(text);
}

static bool light_rows(weft_light *light, bool removable, bool *removed)
{
    double theta_rad = light->direction.theta_rad, phi_rad = light->direction.phi_rad;
    double height_rad = WEFT_PI / 2 - theta_rad;
    bool changed = weft_ui_angle("Height", &height_rad, -20, 90);
    if (changed)
        theta_rad = WEFT_PI / 2 - height_rad;
    changed |= weft_ui_angle("Around", &phi_rad, -360, 360);
    light->direction = (weft_angles){theta_rad, phi_rad};
    changed |= weft_ui_colour("Irradiance", light->irradiance);
    *removed = removable && weft_ui_button("Remove this light");
    return changed || *removed;
}

static void lights(weft_interaction *i)
{
    weft_scene *scene = &i->scene;
    for (int l = 0; l < scene->light_count; l++) {
        char name[32];
        bool removed = false;
        snprintf(name, sizeof name, l == 0 ? "Key light" : "Light %d", l + 1);
        if (!weft_ui_section(name, false))
            continue;
        bool removable = scene->light_count > 1 || scene->environment;
        i->changed |= light_rows(&scene->light[l], removable, &removed);
        if (removed) {
            memmove(&scene->light[l], &scene->light[l + 1],
                    (size_t)(scene->light_count - l - 1) * sizeof *scene->light);
            scene->light_count--;
            return;
        }
    }
}

static void add_light(weft_interaction *i)
{
    weft_scene *scene = &i->scene;
    weft_ui_disable(scene->light_count == WEFT_SCENE_MAX_LIGHTS);
    if (weft_ui_button("Add a light")) {
        weft_light light = weft_scene_default().light[0];
        light.direction.phi_rad += WEFT_PI * scene->light_count / 2;
        scene->light[scene->light_count++] = light;
        i->changed = true;
    }
    weft_ui_enable();
}

/* With its own key light, shadows and ground; "Bare": one light and nothing else. */
static void surroundings_row(weft_application *a)
{
    static const char *const name[] = {"Studio", "Overcast", "Sky", "Bare"};
    const char *shown = a->setup.settings->environment;
    int chosen = a->interaction.scene.environment ? -1 : 3;
    for (int k = 0; chosen < 0 && shown && weft_surroundings_names[k]; k++)
        chosen = strcmp(shown, weft_surroundings_names[k]) == 0 ? k : chosen;
    if (weft_ui_choice("Set", &chosen, name, NULL, 4))
        a->interaction.wants_surroundings = chosen < 3 ? weft_surroundings_names[chosen] : "none";
}

static void environment_rows(weft_application *a)
{
    weft_interaction *i = &a->interaction;
    weft_scene *scene = &i->scene;
    if (!weft_player_has_environment(a->player))
        return;
    i->changed |= weft_ui_toggle("Environment", &scene->environment);
    weft_scene_keep_lit(scene);
    if (!scene->environment)
        return;
    i->changed |= weft_ui_slider("Strength", &scene->environment_strength, 0.01, 20, "%.2f", true);
    i->changed |= weft_ui_angle("Turn", &scene->environment_turn_rad, -180, 180);
}

static void light_section(weft_application *a)
{
    weft_interaction *i = &a->interaction;
    direction_map(a);
    weft_ui_same_line();
    map_legend(a);
    i->changed |= weft_ui_toggle("Shadows", &i->scene.shadows);
    weft_ui_same_line();
    i->changed |= weft_ui_toggle("Ground", &i->scene.ground);
    weft_ui_same_line();
    add_light(i);
    surroundings_row(a);
    environment_rows(a);
    lights(i);
}

/* ---- Material ---- */

/* Fewer components are a coarser material that is drawn faster. */
static void component_rows(weft_application *a)
{
    weft_interaction *i = &a->interaction;
    int count = weft_player_layer_count(a->player), lobes, groups;
    bool view_table, light_table;
    if (count == 0)
        return;
    weft_player_material_parts(a->player, &lobes, &view_table, &light_table);
    groups = weft_player_drawn_components(a->player, &i->scene) / WEFT_COMPONENTS_GROUP;
    if (weft_ui_whole("Components / 4", &groups, lobes < 0, count / WEFT_COMPONENTS_GROUP)) {
        i->scene.components = WEFT_COMPONENTS_GROUP * groups;
        i->changed = true;
    }
    char text[64];
    snprintf(text, sizeof text,
             groups > 0 ? "%d of %d components, %d bytes a texel" : "Lobes in the place of components",
             WEFT_COMPONENTS_GROUP * groups, count, WEFT_COMPONENTS_GROUP * groups);
    weft_ui_text(text);
}

static void relief_row(weft_application *a)
{
    char text[64];
    double range_mm[2];
    if (!weft_player_relief_mm(a->player, range_mm))
        return;
    snprintf(text, sizeof text, "Relief, %.3g to %.3g mm", range_mm[0], range_mm[1]);
    a->interaction.changed |= weft_ui_toggle(text, &a->interaction.scene.relief);
}

static void material_section(weft_application *a)
{
    weft_interaction *i = &a->interaction;
    weft_scene *scene = &i->scene;
    int lobes;
    relief_row(a);
    component_rows(a);
    bool view_table, light_table;
    weft_player_material_parts(a->player, &lobes, &view_table, &light_table);
    for (int lobe = 0; lobe < lobes; lobe++) {
        char name[32];
        snprintf(name, sizeof name, "Lobe %d", lobe + 1);
        i->changed |= weft_ui_toggle(name, &scene->lobe[lobe]);
        if (lobe + 1 < lobes)
            weft_ui_same_line();
    }
    weft_ui_disable(!view_table);
    i->changed |= weft_ui_toggle("View table T", &scene->view_table);
    weft_ui_enable();
    weft_ui_same_line();
    weft_ui_disable(!light_table);
    i->changed |= weft_ui_toggle("Light table S", &scene->light_table);
    weft_ui_enable();
}

/* ---- Picture ---- */

static void mesh_row(weft_application *a)
{
    static const char *const name[] = {"Drape", "Ball", "Plane"}, *const wish[] = {"drape", "sphere", "plane"};
    int chosen = -1;
    for (int mesh = 0; mesh < 3; mesh++)
        chosen = strcmp(a->setup.settings->mesh, wish[mesh]) == 0 ? mesh : chosen;
    if (weft_ui_choice("Mesh", &chosen, name, NULL, 3))
        a->interaction.wants_mesh = wish[chosen];
}

static void surface_rows(weft_interaction *i)
{
    static const char *const level[] = {"Trilinear", "Nearest", "None"};
    int choice = (int)i->scene.level_choice;
    i->changed |= weft_ui_slider("Repeats", &i->scene.repeat, 0.25, 256, "%.2f", true);
    if (weft_ui_choice("Mip levels", &choice, level, NULL, 3)) {
        i->scene.level_choice = (weft_level_choice)choice;
        i->changed = true;
    }
}

static void picture_section(weft_application *a)
{
    weft_interaction *i = &a->interaction;
    static const char *const tone[] = {"Clip", "Soft"}, *const filter[] = {"Auto", "Exact", "Stochastic"};
    weft_scene *scene = &i->scene;
    int tone_choice = (int)scene->tone, filter_choice = (int)scene->filter;
    mesh_row(a);
    surface_rows(i);
    i->changed |= weft_ui_slider("Exposure", &scene->exposure, 0.05, 20, "%.2f", true);
    i->changed |= weft_ui_choice("Highlights", &tone_choice, tone, NULL, WEFT_TONE_COUNT);
    i->changed |= weft_ui_choice("Filter", &filter_choice, filter, NULL, WEFT_FILTER_COUNT);
    scene->tone = (weft_tone)tone_choice;
    scene->filter = (weft_filter)filter_choice;
    i->changed |= weft_ui_toggle("Show levels", &scene->show_level);
    weft_ui_same_line();
    i->changed |= weft_ui_toggle("Tint extrapolation", &scene->show_extrapolation);
}

/* ---- Facts ---- */

static void size_rows(const weft_application *a)
{
    static const char *const name[] = {"Raw", "Compressed", "Analytic"};
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++) {
        size_t bytes = weft_player_bytes(a->player, (weft_mode)mode);
        const char *path = weft_application_file(a, (weft_mode)mode), *slash = path ? strrchr(path, '/') : NULL;
        char text[160];
        snprintf(text, sizeof text, "%.3g MB %s  %s", 1e-6 * (double)bytes,
                 mode == WEFT_MODE_RAW ? weft_player_raw_format(a->player) : "",
                 slash  ? slash + 1
                 : path ? path
                        : "");
        if (bytes > 0)
            weft_ui_value(name[mode], text);
    }
}

static void title(const weft_application *a)
{
    char text[96];
    const weft_canvas *canvas = &a->canvas;
    weft_ui_heading(a->title);
    int used = snprintf(text, sizeof text, "%.1f ms a frame, %.0f frames/s   ", a->frame_ms,
                        a->frame_ms > 0 ? 1000 / a->frame_ms : 0);
    if (canvas->drawn_width < canvas->width)
        snprintf(text + used, sizeof text - (size_t)used, "at %d x %d", canvas->drawn_width, canvas->drawn_height);
    else
        snprintf(text + used, sizeof text - (size_t)used, "H: all keys");
    weft_ui_dim_text(text);
    weft_ui_gap();
}

static void facts_section(const weft_application *a)
{
    char text[96];
    snprintf(text, sizeof text, "%d x %d   mean of %d", a->canvas.width, a->canvas.height, a->canvas.frame_count);
    weft_ui_value("Picture", text);
    size_rows(a);
    weft_ui_gap();
    weft_ui_dim_text(a->held_out);
    weft_ui_dim_text(a->errors[0] ? a->errors
                     : a->interaction.available[WEFT_MODE_RAW]
                         ? "The errors of what is visible are measured once the picture rests."
                         : "Drop the dataset on the window, and the errors are measured.");
}

void weft_panel_show(weft_application *a, int width, int height)
{
    weft_interaction *i = &a->interaction;
    int panel = weft_panel_width(a);
    if (panel > 0) {
        weft_ui_panel_begin("panel", 0, 0, panel, height);
        title(a);
        view_section(i);
        if (weft_ui_section("Light", true))
            light_section(a);
        if (weft_ui_section("Under the pointer", true))
            weft_panel_show_probe(a);
        if (i->available[WEFT_MODE_COMPRESSED] && weft_ui_section("Compressed material", true))
            material_section(a);
        if (i->available[WEFT_MODE_ANALYTIC] && weft_ui_section("Weave", false))
            weft_panel_show_weave(a);
        if (weft_ui_section("Picture", true))
            picture_section(a);
        if (weft_ui_section("Size and error", true))
            facts_section(a);
        weft_panel_show_files(a);
        weft_ui_gap();
        weft_ui_dim_text("H: mouse and keys");
        weft_ui_panel_end();
    }
    weft_panel_show_notes(a, panel, width, height);
}
