#include "player/window/panel.h"

#include "base/clock.h"
#include "player/window/held_out_message.h"
#include "player/window/keys.h"
#include "player/window/ui/ui_bridge.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PLOT_SIZE = 142 };

static const double poll_s = 0.1;
static const double turn_rad_per_s = 0.5;
static const double short_note_s = 1.5;
static const double poll_of_loading_s = 0.01; /* frames that show nothing new would take from the thread that reads */

/* ---- Events ---- */

static double picture_x(const weft_application *a, double x)
{
    return x - weft_panel_width(a);
}

/* Where the pointer is now: what the widgets know of it is as old as the last frame. */
static bool is_on_picture(const weft_application *a, double x)
{
    return picture_x(a, x) >= 0 && !weft_ui_holds_mouse();
}

static void on_press(void *context, int button, bool pressed, int modifiers, double x, double y)
{
    weft_application *a = context;
    if (pressed)
        weft_history_note(&a->history, &a->interaction.scene, &a->weave);
    if (!pressed || is_on_picture(a, x))
        weft_interaction_press(&a->interaction, button, pressed, modifiers, picture_x(a, x), y);
}

static void on_move(void *context, double x, double y)
{
    weft_application *a = context;
    weft_interaction_move(&a->interaction, picture_x(a, x), y);
}

static void on_scroll(void *context, double steps)
{
    weft_application *a = context;
    bool scrolls_list = a->interaction.shows_help;
    if (!scrolls_list && is_on_picture(a, a->interaction.x + weft_panel_width(a)))
        weft_interaction_scroll(&a->interaction, steps);
}

/* A key that was pressed over the picture is released wherever the keys go by then. */
static void on_key(void *context, int key, int action, int modifiers)
{
    weft_application *a = context;
    weft_interaction *i = &a->interaction;
    if (action == GLFW_PRESS && !(modifiers & GLFW_MOD_CONTROL))
        weft_history_note(&a->history, &i->scene, &a->weave);
    if (action == GLFW_RELEASE)
        weft_keys_release(i, key);
    else if (!weft_ui_wants_keyboard())
        weft_keys_press(i, key, modifiers, action == GLFW_REPEAT);
    if (i->message[0]) {
        weft_application_show_message(a, false, i->message);
        a->note_ends_s = weft_now_s() + short_note_s;
        i->message[0] = 0;
    }
}

static void on_drop(void *context, const char *path)
{
    weft_application_open(context, path);
}

/* ---- Life ---- */

static weft_code open_window(weft_application *a, weft_error *error)
{
    const weft_window_events events = {on_press, on_move, on_scroll, on_key, on_drop, a};
    const weft_settings *settings = a->setup.settings;
    char title[sizeof a->title + 8];
    snprintf(title, sizeof title, "Weft - %s", a->title);
    WEFT_TRY(weft_window_create(title, settings->width, settings->height, &events, &a->window, error));
    a->scale = weft_window_scale(a->window);
    WEFT_TRY(weft_ui_create(weft_window_handle(a->window), a->scale, error));
    WEFT_TRY(weft_probe_plots_create((int)(PLOT_SIZE * a->scale), &a->plots, error));
    WEFT_TRY(weft_player_create(&a->player, error));
    return weft_scene_loader_attach(a->loader, a->player, error);
}

/* The name stays as other files are dropped. */
static void name_after_first_file(weft_application *a)
{
    const weft_settings *settings = a->setup.settings;
    const char *first = settings->material  ? settings->material
                        : settings->dataset ? settings->dataset
                                            : settings->weave;
    const char *slash = strrchr(first, '/');
    snprintf(a->title, sizeof a->title, "%s", slash ? slash + 1 : first);
}

weft_code weft_application_create(const weft_application_setup *setup, weft_application **result, weft_error *error)
{
    *result = NULL;
    weft_application *a = calloc(1, sizeof *a);
    if (!a)
        return weft_fail_memory(error, "application", sizeof *a);
    a->setup = *setup;
    a->progress = -1;
    name_after_first_file(a);
    weft_code code = weft_application_open_files(a, error);
    if (code == WEFT_OK)
        code = open_window(a, error);
    if (code == WEFT_OK)
        *result = a;
    else
        weft_application_free(a);
    return code;
}

void weft_application_free(weft_application *a)
{
    if (!a)
        return;
    weft_application_close_files(a);
    if (a->window) {
        weft_canvas_free(&a->canvas);
        weft_probe_plots_free(&a->plots);
        weft_ui_free();
    }
    weft_weave_edit_free(&a->weave);
    weft_history_free(&a->history);
    weft_player_free(a->player);
    weft_window_free(a->window);
    free(a);
}

/* ---- Wishes ---- */

static void take_back(weft_application *a)
{
    weft_interaction *i = &a->interaction;
    bool weave_changed, is_undo = i->wants_undo;
    weft_error error = {0};
    i->wants_undo = i->wants_redo = false;
    bool found = (is_undo ? weft_history_undo : weft_history_redo)(&a->history, &i->scene, &a->weave, &weave_changed);
    i->changed |= found;
    if (weave_changed && weft_weave_edit_ask(&a->weave, &error) != WEFT_OK)
        weft_application_show_message(a, true, error.message);
    else if (!found)
        weft_application_show_message(a, false, is_undo ? "nothing to undo" : "nothing to do again");
}

/* A weave is not lost by one key. */
static void quit(weft_application *a)
{
    if (a->weave.is_unsaved && !a->has_warned) {
        a->has_warned = true;
        a->interaction.wants_quit = false;
        weft_application_show_message(a, true,
                                      "no file has the weave as it is: save it in the panel, or quit once more");
    } else {
        weft_window_close(a->window);
    }
}

static void grant_wishes(weft_application *a)
{
    weft_interaction *i = &a->interaction;
    if (i->wants_surroundings)
        weft_application_change_surroundings(a);
    if (i->wants_mesh)
        weft_application_change_mesh(a);
    if (i->wants_file) {
        weft_application_open(a, i->wants_file);
        i->wants_file = NULL;
    }
    if (i->wants_reload) {
        i->wants_reload = false;
        weft_application_open(a, NULL);
    }
    /* Before the first frame there is nothing to save, and what was done before the wish is to be seen. */
    if (i->wants_screenshot && a->canvas.frame_count > 0 && !weft_ui_is_behind()) {
        i->wants_screenshot = false;
        weft_application_save_picture(a);
    }
    weft_window_set_full_screen(a->window, i->full_screen);
    if (i->wants_undo || i->wants_redo)
        take_back(a);
    if (i->wants_quit)
        quit(a);
}

static void turn_by_itself(weft_application *a)
{
    double now = weft_now_s();
    if (a->interaction.turns && a->interaction.drag == WEFT_DRAG_NONE)
        weft_interaction_turn(&a->interaction, turn_rad_per_s * (now - a->stepped_s), 0);
    a->stepped_s = now;
}

/* ---- What the material says of itself ---- */

/* NULL where it says nothing, or not all of it is drawn. */
static const weft_hold_out *what_holds(const weft_application *a)
{
    bool is_whole =
        weft_draws_whole_material(&a->interaction.scene, weft_player_layer_count(a->player), a->interaction.has_relief);
    return is_whole ? weft_scene_loader_held_out(a->loader) : NULL;
}

static void say_what_holds(weft_application *a)
{
    const weft_hold_out *held_out = what_holds(a);
    a->held_out[0] = 0;
    if (held_out)
        weft_held_out_message(held_out, a->held_out);
}

/* What the material says of the texel under the pointer, and how sure it is of that. */
static weft_code evaluate_probe(weft_application *a, weft_error *error)
{
    const weft_probe *p = &a->probe;
    const weft_hold_out *held_out = what_holds(a);
    bool is_certified = held_out && held_out->has_certificate && p->mode == WEFT_MODE_COMPRESSED;
    const weft_certificate *certificate = is_certified ? &held_out->certificate : NULL;
    WEFT_TRY(weft_probe_value(&a->plots, a->player, &a->interaction.scene, p, a->reflectance, error));
    a->half_width_probability = certificate ? certificate->probability : 0;
    a->half_width_levels = certificate ? certificate->measured_levels : 0;
    a->half_width_is_measured = certificate && weft_certificate_is_measured(certificate, p->level);
    for (int c = 0; c < 3; c++) {
        a->reflectance[c] *= fmax(0, (double)p->light.z);
        a->half_width[c] =
            certificate ? weft_certificate_half_width(certificate, p->level, a->reflectance[c], p->light, p->view) : 0;
    }
    return WEFT_OK;
}

/* While the picture moves the numbers would be of one frame's choices. */
static weft_code probe(weft_application *a, weft_error *error)
{
    const weft_interaction *i = &a->interaction;
    if (!a->converges || weft_panel_width(a) == 0 || i->drag != WEFT_DRAG_NONE)
        return WEFT_OK;
    weft_probe probe;
    WEFT_TRY(weft_probe_read(a->player, &i->scene, &a->canvas, (int)i->x, (int)i->y, &probe, error));
    if (!probe.on_mesh)
        return WEFT_OK;
    a->probe = probe;
    if (probe.mode == WEFT_MODE_COMPRESSED)
        WEFT_TRY(weft_texel_read(a->player, probe.texel_level, probe.texel_x, probe.texel_y, probe.light, probe.view,
                                 &a->texel, error));
    WEFT_TRY(evaluate_probe(a, error));
    return weft_probe_plots_draw(&a->plots, a->player, &i->scene, &a->probe, error);
}

/* ---- The loop ---- */

static void show(weft_application *a, int width, int height)
{
    double start = weft_now_s();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    glClearColor(0.02f, 0.02f, 0.02f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    if (a->canvas.frame_count > 0)
        weft_canvas_present(&a->canvas, &a->interaction.scene, weft_panel_width(a));
    weft_ui_begin();
    weft_panel_show(a, width, height);
    weft_ui_end();
    /* Before the screen is waited for. */
    glFinish();
    weft_application_note_time(a, 1000 * (weft_now_s() - start));
    weft_window_show(a->window);
}

static void find_modes(weft_application *a)
{
    weft_interaction *i = &a->interaction;
    i->is_reading = a->progress >= 0;
    i->has_environment = weft_player_has_environment(a->player);
    i->has_relief = weft_player_relief_mm(a->player, NULL);
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++)
        i->available[mode] = weft_player_has(a->player, (weft_mode)mode);
    for (int pane = 0; pane < weft_scene_panes(&i->scene); pane++) {
        for (int mode = 0; !i->available[i->scene.pane[pane]] && mode < WEFT_MODE_COUNT; mode++) {
            if (i->available[mode])
                weft_interaction_show(i, (weft_mode)mode);
        }
    }
}

static bool is_drawing(const weft_application *a)
{
    return (weft_application_has_something(a) && !weft_application_is_finished(a)) || a->interaction.changed ||
           weft_ui_is_behind();
}

static bool is_waiting(const weft_application *a)
{
    return a->progress >= 0 || a->weave.is_pending;
}

static double wait_s(const weft_application *a)
{
    return is_drawing(a) ? 0 : is_waiting(a) ? poll_of_loading_s : poll_s;
}

/* What the screen shows is what it would show again. Where frames are timed, each is shown. */
static bool is_idle(weft_application *a)
{
    double now_s = weft_now_s();
    const weft_stir stir = {.has_events = weft_window_take_events(a->window),
                            .is_busy =
                                is_drawing(a) || is_waiting(a) || weft_ui_wants_keyboard() || a->setup.frame_limit > 0,
                            .note_ends_s = a->note_ends_s};
    return weft_idle_at(&a->idle, &stir, now_s);
}

static weft_code step(weft_application *a, weft_error *error)
{
    int width, height;
    grant_wishes(a);
    turn_by_itself(a);
    weft_application_poll_files(a);
    weft_panel_follow_weave(a);
    if (is_idle(a))
        return WEFT_OK;
    find_modes(a);
    say_what_holds(a);
    /* A window that would stay empty closes, and says why. */
    if (!weft_application_has_something(a) && a->progress < 0 && a->failure.code != WEFT_OK)
        return weft_fail(error, a->failure.code, "%s", a->failure.message);
    weft_window_size(a->window, &width, &height);
    int left = weft_panel_width(a);
    if (width <= left || height == 0)
        return WEFT_OK;
    WEFT_TRY(weft_application_prepare_canvas(a, width - left, height, error));
    if (weft_application_has_something(a)) {
        WEFT_TRY(weft_application_draw(a, error));
        WEFT_TRY(probe(a, error));
    }
    show(a, width, height);
    return weft_gl_check("showing the window", error);
}

weft_code weft_application_run(weft_application *a, weft_error *error)
{
    const weft_scene *scene = &a->setup.settings->scene;
    a->interaction = (weft_interaction){.scene = *scene, .start = *scene, .changed = true, .shows_panel = true};
    a->interaction.before = scene->pane[0];
    a->interaction.drag_moves_light = a->interaction.points_light = a->setup.settings->is_of_one_view;
    if (a->interaction.points_light)
        weft_application_show_message(a, false, "one view: drags move the light to the pointer (L: turn the cloth)");
    a->stepped_s = weft_now_s();
    find_modes(a);
    long limit = a->setup.frame_limit;
    while (weft_window_poll(a->window, wait_s(a)) && (limit == 0 || a->frame_count < limit))
        WEFT_TRY(step(a, error));
    return WEFT_OK;
}
