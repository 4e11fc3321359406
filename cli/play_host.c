#include "cli/play_host.h"

#include "base/clock.h"
#include "cli/scene_errors.h"
#include "cli/scene_part.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

weft_code play_host_create(scene_options *scene, play_host *host, weft_error *error)
{
    weft_error no_watch;
    *host = (play_host){.scene = scene};
    if (weft_watch_create(&host->watch, &no_watch) != WEFT_OK)
        command_say(&scene->common, "%s", no_watch.message);
    WEFT_TRY(weft_space_mouse_create(&host->mouse, error));
    return scene_loader_create(scene, &host->loader, error);
}

void play_host_free(play_host *host)
{
    scene_loader_free(host->loader);
    weft_space_mouse_free(host->mouse);
    weft_watch_free(host->watch);
}

/* ---- Screenshots and numbers ---- */

/* The first free of weft-001.png, weft-002.png, ... in the current folder. */
static weft_code save_screenshot(void *context, const weft_scene *scene, int width, int height,
                                 char note[WEFT_NOTE_SIZE], weft_error *error)
{
    play_host *host = context;
    weft_settings *settings = &host->scene->settings;
    char path[32];
    int number = 1;
    do
        snprintf(path, sizeof path, "weft-%03d.png", number++);
    while (access(path, F_OK) == 0 && number < 1000);
    settings->scene = *scene;
    settings->width = width;
    settings->height = height;
    WEFT_TRY(weft_settings_draw(path, weft_application_player(host->application), settings, NULL, error));
    snprintf(note, WEFT_NOTE_SIZE, "saved %s", path);
    command_say(&host->scene->common, "%s", note);
    return WEFT_OK;
}

static weft_code measure_errors(void *context, const weft_scene *scene, int width, int height,
                                char note[WEFT_NOTE_SIZE], weft_error *error)
{
    const play_host *host = context;
    return scene_errors_print(weft_application_player(host->application), scene, width, height, note, error);
}

/* ---- Files ---- */

static weft_code change_mesh(void *context, const char *name, weft_scene *scene, weft_error *error)
{
    (void)scene;
    play_host *host = context;
    return scene_loader_open_mesh(host->loader, name, error);
}

/* The panel names the files, and those are watched. */
static weft_code follow_files(play_host *host, weft_error *error)
{
    const weft_settings *s = &host->scene->settings;
    const char *const path[] = {s->material, s->mesh, s->weave, s->environment, s->dataset};
    weft_application_set_file(host->application, WEFT_MODE_COMPRESSED, s->material);
    weft_application_set_file(host->application, WEFT_MODE_ANALYTIC, s->weave);
    weft_application_set_file(host->application, WEFT_MODE_RAW, s->dataset);
    weft_application_set_mesh(host->application, s->mesh);
    for (int slot = 0; host->watch && slot < SCENE_SLOT_COUNT; slot++) {
        bool is_file = path[slot] && access(path[slot], F_OK) == 0;
        WEFT_TRY(weft_watch_set(host->watch, slot, is_file ? path[slot] : NULL, error));
    }
    return WEFT_OK;
}

static weft_code open_file(void *context, const char *path, weft_scene *scene, char note[WEFT_NOTE_SIZE],
                           weft_error *error)
{
    play_host *host = context;
    host->scene->settings.scene = *scene;
    weft_code code = path ? scene_loader_open(host->loader, path, error) : scene_loader_reload(host->loader, error);
    *scene = host->scene->settings.scene;
    weft_error ignored;
    follow_files(host, &ignored);
    if (code == WEFT_OK)
        snprintf(note, WEFT_NOTE_SIZE, "reading %.256s", path ? path : "all files again");
    return code;
}

static weft_code reload_changed(play_host *host, double now_s, weft_error *error)
{
    int slot = host->watch ? weft_watch_poll(host->watch, now_s) : -1;
    return slot < 0 ? WEFT_OK : scene_loader_reload_slot(host->loader, slot, error);
}

static weft_code show_arrived(play_host *host, weft_scene *scene, bool *changed, char note[WEFT_NOTE_SIZE],
                              weft_error *error)
{
    char said[WEFT_MESSAGE_SIZE];
    bool shown;
    host->scene->settings.scene = *scene;
    weft_code code = scene_loader_poll(host->loader, &shown, said, error);
    if (!shown)
        return code;
    *scene = host->scene->settings.scene;
    *changed = true;
    snprintf(note, WEFT_NOTE_SIZE, "%s", said);
    if (said[0])
        command_say(&host->scene->common, "%s", said);
    /* Even where another file failed in the same slice: the names shown before are gone. */
    weft_error ignored;
    weft_code followed = follow_files(host, code == WEFT_OK ? error : &ignored);
    return code == WEFT_OK ? followed : code;
}

/* ---- The SpaceMouse ---- */

static bool follow_mouse(play_host *host, weft_scene *scene, double now_s, char note[WEFT_NOTE_SIZE])
{
    weft_space_motion motion;
    weft_space_mouse_poll(host->mouse, now_s, &motion);
    const char *message = weft_space_mouse_message(host->mouse);
    if (strcmp(message, host->mouse_message) != 0) {
        snprintf(host->mouse_message, sizeof host->mouse_message, "%s", message);
        if (message[0]) {
            snprintf(note, WEFT_NOTE_SIZE, "%s", message);
            command_say(&host->scene->common, "%s", message);
        }
    }
    return weft_space_mouse_move(&scene->orbit, &motion, now_s - host->polled_s);
}

static weft_code poll_host(void *context, weft_scene *scene, double *progress, bool *changed, char note[WEFT_NOTE_SIZE],
                           weft_error *error)
{
    play_host *host = context;
    double now = weft_now_s();
    *changed = follow_mouse(host, scene, now, note);
    host->polled_s = now;
    weft_code code = reload_changed(host, now, error);
    if (code == WEFT_OK)
        code = show_arrived(host, scene, changed, note, error);
    *progress = scene_loader_progress(host->loader);
    return code;
}

weft_application_host play_host_calls(play_host *host)
{
    return (weft_application_host){
        .context = host,
        .save = save_screenshot,
        .mesh = change_mesh,
        .measure = measure_errors,
        .open = open_file,
        .poll = poll_host,
    };
}
