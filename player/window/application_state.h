/* The inside of weft_application: what the loop (application.c), the panel and the files share. */
#ifndef WEFT_PLAYER_WINDOW_APPLICATION_STATE_H
#define WEFT_PLAYER_WINDOW_APPLICATION_STATE_H

#include "player/draw/pace.h"
#include "player/draw/probe.h"
#include "player/gl/context.h"
#include "player/settings/scene_part.h"
#include "player/window/application.h"
#include "player/window/files.h"
#include "player/window/history.h"
#include "player/window/idle.h"
#include "player/window/interaction.h"
#include "player/window/space_mouse.h"
#include "player/window/weave_edit.h"

#include <limits.h>

struct weft_application {
    weft_application_setup setup;
    char title[256];
    /* What arrives while the window is open */
    weft_scene_loader *loader;
    weft_space_mouse *mouse;
    weft_watch *watch;        /* NULL where the system has none */
    weft_folder_files folder; /* that one can choose from; read when its list is looked at */
    double polled_s;
    char mouse_message[WEFT_MESSAGE_SIZE]; /* told last */
    /* The picture */
    weft_window *window;
    weft_player *player;
    weft_canvas canvas;
    weft_interaction interaction;
    double scale;              /* of text and widgets */
    weft_pace pace;            /* of moving frames */
    double frame_ms;           /* smoothed: from the scene to the screen, of all frames */
    bool drew_interactive;     /* the last frame */
    double drawn_ms;           /* that the last frame took to draw; 0: none was drawn since the last one shown */
    double moved_s, stepped_s; /* when the picture changed last, and when the last frame began */
    double total_ms;
    long frame_count;
    bool converges;        /* the mean of the frames so far is of a picture that no longer changes */
    weft_probe probe;      /* of the pixel of the mesh that the pointer was over last */
    weft_texel texel;      /* of it, where that is compressed */
    double reflectance[3]; /* BRDF x pi x cosine of the light, there, and half of the interval about it: */
    double half_width[3];  /* 0 where the material does not say, or what is shown is not what it says it of */
    double half_width_probability;
    int half_width_levels;       /* on which it was measured: the first ones; 0: not known */
    bool half_width_is_measured; /* on the level that is shown; else it is rather too wide */
    weft_probe_plots plots;
    weft_weave_edit weave; /* what the sliders change */
    weft_history history;  /* of lights, weave, and what is shown */
    bool has_warned;       /* that quitting would lose the weave as it is */
    int noise_seed;        /* of the noise that was on last; 0: none yet */
    double progress;
    weft_error failure;                 /* of reading, last */
    char errors[WEFT_NOTE_SIZE];        /* of what is shown, "" until it rests */
    char unmeasured[WEFT_MESSAGE_SIZE]; /* how much of it was, the same */
    char held_out[WEFT_HOLD_OUT_LINE];  /* what the material says of its error; "" unless all of it is drawn */
    bool is_exposed;                    /* once, when all files have arrived */
    char note[WEFT_NOTE_SIZE];          /* told to the user */
    bool note_is_error;
    double note_ends_s;
    weft_idle idle;
};

/* Tells the user; `is_error` in red. */
void weft_application_show_message(weft_application *application, bool is_error, const char *text);

/* ---- Frames ---- */

/* Whether there is a mesh and something to draw it with. */
bool weft_application_has_something(const weft_application *application);

/* Whether the picture rests and has all frames of its mean. */
bool weft_application_is_finished(const weft_application *application);

/* Makes a canvas as large as the picture, begun anew when that is out of date. Errors: those of weft_canvas_create. */
weft_code weft_application_prepare_canvas(weft_application *application, int width, int height, weft_error *error);

/* Draws one frame more, unless the mean is finished or a moving picture stands; exposes the scene before, once all
 * is there that the command line named. Errors: those of drawing. */
weft_code weft_application_draw(weft_application *application, weft_error *error);

/* Notes what the last frame took, after it was brought to the screen in `shown_ms`. */
void weft_application_note_time(weft_application *application, double shown_ms);

/* ---- Files and devices ---- */

/* Begins to read what the settings name and looks for devices; before there is a window. Errors: WEFT_SYSTEM. */
weft_code weft_application_open_files(weft_application *application, weft_error *error);
void weft_application_close_files(weft_application *application);

/* The file that a mode shows; NULL: none. */
const char *weft_application_file(const weft_application *application, weft_mode mode);

/* Begins to read a file, or all again (NULL), and tells the outcome. */
void weft_application_open(weft_application *application, const char *path);

/* Lists a folder; NULL: that of the file that is shown. Tells where memory is short. */
void weft_application_list(weft_application *application, const char *folder);

/* Begins to read the mesh that was wished for. */
void weft_application_change_mesh(weft_application *application);
void weft_application_change_surroundings(weft_application *application);

/* Takes in what has been read, what has changed on disk, and the SpaceMouse. */
void weft_application_poll_files(weft_application *application);

/* Saves the picture with its settings as weft-001.png, weft-002.png, ..., the first that is free in the current folder,
 * and tells so. */
void weft_application_save_picture(weft_application *application);

#endif
