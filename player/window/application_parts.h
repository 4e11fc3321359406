/* The inside of weft_application, shared by the files that make it. */
#ifndef WEFT_PLAYER_WINDOW_APPLICATION_PARTS_H
#define WEFT_PLAYER_WINDOW_APPLICATION_PARTS_H

#include "player/draw/lobe_probe.h"
#include "player/draw/probe.h"
#include "player/window/application.h"
#include "player/window/interaction.h"
#include "player/window/weave_edit.h"

struct weft_application {
    weft_application_setup setup;
    weft_window *window;
    weft_player *player;
    weft_canvas canvas;
    weft_interaction interaction;
    double scale;              /* of text and widgets */
    double frame_ms, exact_ms; /* smoothed: of all frames, and of those that evaluate every neighbour */
    double moved_s, stepped_s; /* when the picture changed last, and when the last frame began */
    double total_ms;
    long frame_count;
    bool rests;       /* the mean of the frames so far is of a picture that no longer changes */
    const char *mesh; /* that is shown: a file or the name of a built-in one */
    weft_probe probe; /* of the pixel of the mesh that the pointer was over last */
    weft_texel texel; /* of it, where that is compressed */
    weft_probe_plots plots;
    weft_weave_edit weave; /* what the sliders change */
    int noise_seed;        /* of the noise that was on last; 0: none yet */
    double progress;
    weft_error failure;          /* of reading, last */
    char errors[WEFT_NOTE_SIZE]; /* of what is shown, "" until it rests */
    char note[WEFT_NOTE_SIZE];   /* told to the user */
    bool note_is_error;
    double note_ends_s;
};

/* Tells the user; `is_error` in red. */
void weft_application_tell(weft_application *application, bool is_error, const char *text);

/* Asks the host to open a file, or all again (NULL), and tells the outcome. */
void weft_application_open(weft_application *application, const char *path);

/* Pixels that the panel takes from the left of the window. */
int weft_application_panel_width(const weft_application *application);

/* All widgets of one frame; changes the interaction and its scene. `width`, `height`: of the window. */
void weft_application_show_panel(weft_application *application, int width, int height);

/* Over the picture: what goes on, what was done, and the list of keys. */
void weft_application_show_notes(const weft_application *application, int width, int height);

/* Its section on what lies under the pointer. */
void weft_application_show_probe(const weft_application *application);

/* Where a direction lies on a disc of the upper hemisphere whose areas are solid angles: the radius is sin(theta / 2)
 * sqrt(2). x, y: the upper left corner of the disc. */
void weft_application_place(weft_vec3 direction, double x, double y, double radius, double *at_x, double *at_y);

/* Shows what has become of a changed weave. */
void weft_application_follow_weave(weft_application *application);

/* Its section on the weave that is shown. */
void weft_application_show_weave(weft_application *application);

#endif
