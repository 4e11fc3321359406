/* The window that plays: picture, panel, and what the user does. */
#ifndef WEFT_PLAYER_WINDOW_APPLICATION_H
#define WEFT_PLAYER_WINDOW_APPLICATION_H

#include "player/draw/player.h"
#include "player/gl/context.h"

enum { WEFT_NOTE_SIZE = 512 };

/* What the application asks of the program around it; each may be NULL. All run on the application's thread; an error
 * of theirs is shown in the window, and the window stays. */
typedef struct weft_application_host {
    void *context;
    /* Draws and saves a picture of the scene; *note receives what to tell the user, such as its path. */
    weft_code (*save)(void *context, const weft_scene *scene, int width, int height, char note[WEFT_NOTE_SIZE],
                      weft_error *error);
    /* Gives the player this mesh; scene->repeat may be changed. */
    weft_code (*mesh)(void *context, const char *name, weft_scene *scene, weft_error *error);
    /* One line on the errors of what the scene shows, "" for none. */
    weft_code (*measure)(void *context, const weft_scene *scene, int width, int height, char note[WEFT_NOTE_SIZE],
                         weft_error *error);
    /* A file was dropped, or all are to be read again (path NULL). *scene may be changed. */
    weft_code (*open)(void *context, const char *path, weft_scene *scene, char note[WEFT_NOTE_SIZE], weft_error *error);
    /* Called once a frame, for what goes on in the background: *progress receives its share, below 0 for nothing under
     * way; *changed whether the picture is out of date. */
    weft_code (*poll)(void *context, weft_scene *scene, double *progress, bool *changed, char note[WEFT_NOTE_SIZE],
                      weft_error *error);
} weft_application_host;

typedef struct weft_application_setup {
    const char *title;                 /* beside "Weft" */
    const char *file[WEFT_MODE_COUNT]; /* what each mode shows, or NULL */
    int width, height;                 /* of the window, screen coordinates */
    long frame_limit;                  /* 0: until the window is closed */
    weft_application_host host;
} weft_application_setup;

typedef struct weft_application weft_application;

/* Opens the window, whose context is current from then on. Errors: WEFT_SYSTEM. The caller frees with
 * weft_application_free. */
weft_code weft_application_create(const weft_application_setup *setup, weft_application **result, weft_error *error);
void weft_application_free(weft_application *application);

/* Its player; what it shows is the caller's to set before weft_application_run. */
weft_player *weft_application_player(weft_application *application);

/* Names what a mode shows; the text must live on. NULL: nothing. */
void weft_application_set_file(weft_application *application, weft_mode mode, const char *path);

/* Names the mesh that is shown; the text must live on. */
void weft_application_set_mesh(weft_application *application, const char *name);

/* Runs until the window is closed or the frames are drawn. Strings of the setup must live on. Errors: WEFT_SYSTEM where
 * drawing fails. */
weft_code weft_application_run(weft_application *application, const weft_scene *scene, weft_error *error);

/* Frames drawn so far and the mean time of one. */
void weft_application_speed(const weft_application *application, long *frames, double *frame_ms);

#endif
