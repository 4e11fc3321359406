/* What `weft play` does for its window: files, screenshots, the SpaceMouse. */
#ifndef WEFT_CLI_PLAY_HOST_H
#define WEFT_CLI_PLAY_HOST_H

#include "cli/scene_load.h"
#include "player/window/application.h"
#include "player/window/space_mouse/space_mouse.h"
#include "player/window/watch.h"

typedef struct play_host {
    scene_options *scene;
    scene_loader *loader;
    weft_application *application; /* set by the caller, once there is one */
    weft_space_mouse *mouse;
    weft_watch *watch; /* NULL where the system has none */
    double polled_s;
    char mouse_message[WEFT_MESSAGE_SIZE]; /* told last */
} play_host;

/* Begins to read the files of `scene`, which must live on. The caller frees with play_host_free, before the
 * application, also on failure. Errors: WEFT_SYSTEM. */
weft_code play_host_create(scene_options *scene, play_host *host, weft_error *error);
void play_host_free(play_host *host);

/* For weft_application_setup. */
weft_application_host play_host_calls(play_host *host);

#endif
