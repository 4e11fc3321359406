/* The window that plays: picture, panel, files that arrive and change, and what the user does. */
#ifndef WEFT_PLAYER_WINDOW_APPLICATION_H
#define WEFT_PLAYER_WINDOW_APPLICATION_H

#include "base/progress.h"
#include "player/settings/scene_loader.h"

enum { WEFT_NOTE_SIZE = 512 };

/* One line on the errors of what the scene shows in a picture of width x height, "" for none. */
typedef weft_code weft_scene_measure(weft_player *player, const weft_scene *scene, int width, int height,
                                     char text[WEFT_NOTE_SIZE], weft_error *error);

typedef struct weft_application_setup {
    weft_settings *settings;     /* what is shown first; its size is that of the window, in screen coordinates */
    long frame_limit;            /* 0: until the window is closed */
    weft_scene_measure *measure; /* of a picture that rests */
    weft_log log;                /* hears what the user is told of files and devices */
} weft_application_setup;

typedef struct weft_application weft_application;

/* Begins to read the files that the settings name, which must live on, and opens the window, whose context is current
 * from then on. Errors: WEFT_SYSTEM. The caller frees with weft_application_free. */
weft_code weft_application_create(const weft_application_setup *setup, weft_application **result, weft_error *error);
void weft_application_free(weft_application *application);

/* Runs until the window is closed or the frames are drawn. Errors: WEFT_SYSTEM where drawing fails; that of a file
 * where nothing can be shown. */
weft_code weft_application_run(weft_application *application, weft_error *error);

/* Frames drawn so far and the mean time of one. */
void weft_application_speed(const weft_application *application, long *frames, double *frame_ms);

#endif
