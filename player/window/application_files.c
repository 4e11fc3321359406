#include "player/window/application_state.h"

#include "base/clock.h"
#include "player/scene/surroundings.h"
#include "player/settings/scene_part.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const double note_s = 8;

void weft_application_show_message(weft_application *a, bool is_error, const char *text)
{
    if (!text[0])
        return;
    snprintf(a->note, sizeof a->note, "%s", text);
    a->note_is_error = is_error;
    a->note_ends_s = weft_now_s() + note_s;
}

/* What failed is told and the window stays. */
static void show_outcome(weft_application *a, weft_code code, const weft_error *error, const char *note)
{
    weft_application_show_message(a, code != WEFT_OK, code == WEFT_OK ? note : error->message);
}

/* ---- Life ---- */

weft_code weft_application_open_files(weft_application *a, weft_error *error)
{
    weft_error no_watch;
    if (weft_watch_create(&a->watch, &no_watch) != WEFT_OK)
        weft_log_line(&a->setup.log, no_watch.message);
    WEFT_TRY(weft_space_mouse_create(&a->mouse, error));
    return weft_scene_loader_create(a->setup.settings, &a->loader, error);
}

void weft_application_close_files(weft_application *a)
{
    weft_scene_loader_free(a->loader);
    weft_space_mouse_free(a->mouse);
    weft_watch_free(a->watch);
    weft_folder_files_free(&a->folder);
}

/* ---- Files ---- */

const char *weft_application_file(const weft_application *a, weft_mode mode)
{
    const weft_settings *s = a->setup.settings;
    const char *const path[WEFT_MODE_COUNT] = {s->dataset, s->material, s->weave};
    return path[mode];
}

void weft_application_list(weft_application *a, const char *folder)
{
    char shown[PATH_MAX] = ".";
    weft_error error = {0};
    const weft_settings *s = a->setup.settings;
    const char *path = s->material ? s->material : s->dataset ? s->dataset : s->weave;
    const char *slash = path ? strrchr(path, '/') : NULL;
    if (slash)
        snprintf(shown, sizeof shown, "%.*s", slash > path ? (int)(slash - path) : 1, path);
    if (weft_folder_files_read(&a->folder, folder ? folder : shown, &error) != WEFT_OK)
        weft_application_show_message(a, true, error.message);
}

static weft_code watch_files(weft_application *a, weft_error *error)
{
    const weft_settings *s = a->setup.settings;
    const char *const path[WEFT_SLOT_COUNT] = {s->material, s->mesh, s->weave, s->environment, s->dataset};
    for (int slot = 0; a->watch && slot < WEFT_SLOT_COUNT; slot++) {
        bool is_file = path[slot] && access(path[slot], F_OK) == 0;
        WEFT_TRY(weft_watch_set(a->watch, slot, is_file ? path[slot] : NULL, error));
    }
    return WEFT_OK;
}

void weft_application_open(weft_application *a, const char *path)
{
    weft_scene *scene = &a->setup.settings->scene;
    char note[WEFT_NOTE_SIZE];
    weft_error error = {0}, ignored;
    *scene = a->interaction.scene;
    weft_code code =
        path ? weft_scene_loader_open(a->loader, path, &error) : weft_scene_loader_reload(a->loader, &error);
    a->interaction.scene = *scene;
    a->interaction.changed = true;
    watch_files(a, &ignored);
    snprintf(note, sizeof note, "reading %.256s", path ? path : "all files again");
    show_outcome(a, code, &error, note);
}

void weft_application_change_surroundings(weft_application *a)
{
    weft_error error = {0};
    weft_scene *scene = &a->interaction.scene;
    const char *name = a->interaction.wants_surroundings;
    a->interaction.wants_surroundings = NULL;
    a->interaction.changed = true;
    bool is_bare = !weft_surroundings_are(name);
    if (is_bare)
        *scene = weft_scene_in_bare_light(scene);
    else
        weft_surroundings_light(name, scene);
    scene->shadows = scene->ground = !is_bare;
    if (!is_bare)
        show_outcome(a, weft_scene_loader_open_surroundings(a->loader, name, &error), &error, "");
}

void weft_application_change_mesh(weft_application *a)
{
    weft_error error = {0};
    show_outcome(a, weft_scene_loader_open_mesh(a->loader, a->interaction.wants_mesh, &error), &error, "");
    a->interaction.wants_mesh = NULL;
    a->interaction.changed = true;
}

static weft_code reload_changed(weft_application *a, double now_s, weft_error *error)
{
    int slot = a->watch ? weft_watch_poll(a->watch, now_s) : -1;
    return slot < 0 ? WEFT_OK : weft_scene_loader_reload_slot(a->loader, slot, error);
}

static weft_code show_arrived(weft_application *a, char note[WEFT_NOTE_SIZE], weft_error *error)
{
    weft_scene *scene = &a->setup.settings->scene;
    char said[WEFT_MESSAGE_SIZE];
    bool shown;
    *scene = a->interaction.scene;
    weft_code code = weft_scene_loader_poll(a->loader, &shown, said, error);
    if (!shown)
        return code;
    a->interaction.scene = *scene;
    a->interaction.changed = true;
    snprintf(note, WEFT_NOTE_SIZE, "%s", said);
    if (said[0])
        weft_log_line(&a->setup.log, said);
    /* Even where another file failed in the same slice: the names shown before are gone. */
    weft_error ignored;
    weft_code watched = watch_files(a, code == WEFT_OK ? error : &ignored);
    return code == WEFT_OK ? watched : code;
}

/* ---- The SpaceMouse ---- */

static void follow_mouse(weft_application *a, double now_s, char note[WEFT_NOTE_SIZE])
{
    weft_space_motion motion;
    weft_space_mouse_poll(a->mouse, now_s, &motion);
    const char *message = weft_space_mouse_message(a->mouse);
    if (strcmp(message, a->mouse_message) != 0) {
        snprintf(a->mouse_message, sizeof a->mouse_message, "%s", message);
        snprintf(note, WEFT_NOTE_SIZE, "%s", message);
        if (message[0])
            weft_log_line(&a->setup.log, message);
    }
    a->interaction.changed |= weft_space_mouse_move(&a->interaction.scene.orbit, &motion, now_s - a->polled_s);
    a->polled_s = now_s;
}

void weft_application_poll_files(weft_application *a)
{
    char note[WEFT_NOTE_SIZE] = "";
    weft_error error = {0};
    double now_s = weft_now_s();
    follow_mouse(a, now_s, note);
    weft_code code = reload_changed(a, now_s, &error);
    if (code == WEFT_OK)
        code = show_arrived(a, note, &error);
    a->progress = weft_scene_loader_progress(a->loader);
    show_outcome(a, code, &error, note);
    if (code != WEFT_OK)
        a->failure = error;
}

/* ---- Screenshots ---- */

/* A picture names the file of its weave; what was changed since is not in that. */
static void warn_of_changes(const weft_application *a, char note[WEFT_NOTE_SIZE])
{
    size_t used = strlen(note);
    bool shows_changed = a->weave.is_changed && a->weave.revision == weft_player_weave_revision(a->player);
    if (shows_changed)
        snprintf(note + used, WEFT_NOTE_SIZE - used, "; it names the weave's file, without your changes");
}

void weft_application_save_picture(weft_application *a)
{
    weft_settings *settings = a->setup.settings;
    char path[32], note[WEFT_NOTE_SIZE] = "";
    weft_error error = {0};
    int number = 1;
    do
        snprintf(path, sizeof path, "weft-%03d.png", number++);
    while (access(path, F_OK) == 0 && number < 1000);
    settings->scene = a->interaction.scene;
    settings->width = a->canvas.width;
    settings->height = a->canvas.height;
    weft_code code = weft_settings_draw(path, a->player, settings, NULL, &error);
    if (code == WEFT_OK) {
        snprintf(note, sizeof note, "saved %s", path);
        weft_log_line(&a->setup.log, note);
    }
    warn_of_changes(a, note);
    show_outcome(a, code, &error, note);
}
