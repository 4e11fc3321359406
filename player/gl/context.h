/* Where OpenGL comes from: a context without a display for pictures, or a window. All OpenGL calls of the player go to
 * the context that was made current last, from the thread that made it. */
#ifndef WEFT_PLAYER_GL_CONTEXT_H
#define WEFT_PLAYER_GL_CONTEXT_H

#include "base/status.h"

#include <stdbool.h>

/* Desktop OpenGL 3.3 core, or OpenGL ES 3.0: every shader of the player is written for both. */
typedef enum weft_gl_profile { WEFT_GL_CORE, WEFT_GL_ES } weft_gl_profile;

/* ---- Without a display (EGL) ---- */

typedef struct weft_headless weft_headless;

/* Makes a context on the first graphics device that gives one, else on Mesa's software rasteriser, and makes it
 * current. LIBGL_ALWAYS_SOFTWARE=1 skips the devices. Drawing goes to framebuffer objects only. The caller frees it
 * with weft_headless_free. Errors: WEFT_SYSTEM where EGL is missing or gives no such context. */
weft_code weft_headless_create(weft_gl_profile profile, weft_headless **result, weft_error *error);
void weft_headless_free(weft_headless *headless);

/* ---- A window (GLFW) ---- */

/* What the user did. Positions are pixels of the framebuffer, x right, y down. */
typedef struct weft_window_events {
    void (*press)(void *context, int button, bool pressed, int modifiers, double x, double y); /* GLFW's */
    void (*move)(void *context, double x, double y);
    void (*scroll)(void *context, double steps);
    void (*key)(void *context, int key, int action, int modifiers); /* GLFW's */
    void (*drop)(void *context, const char *path);                  /* a file, once for each that was dropped */
    void *context;
} weft_window_events;

typedef struct weft_window weft_window;

/* Opens a window and makes its context current. `events` is copied; its functions are called by weft_window_poll.
 * The caller frees it with weft_window_free. Errors: WEFT_SYSTEM where there is no display or no OpenGL 3.3. */
weft_code weft_window_create(const char *title, int width, int height, const weft_window_events *events,
                             weft_window **result, weft_error *error);
void weft_window_free(weft_window *window);

/* Handles what the user did since the last call; waits up to `wait_s` for something to happen. False once the user
 * closed the window. */
bool weft_window_poll(weft_window *window, double wait_s);

/* Whether anything has happened to the window since the last call: also what calls none of `events`, as when another
 * window goes away that lay over it. */
bool weft_window_take_events(weft_window *window);
void weft_window_close(weft_window *window);
/* All of the screen that the window is on, or as large as before. */
void weft_window_set_full_screen(weft_window *window, bool full);
/* Size of the framebuffer in pixels; 0 x 0 while minimised. */
void weft_window_size(const weft_window *window, int *width, int *height);
/* Shows what was drawn into framebuffer 0. */
void weft_window_show(weft_window *window);

/* The GLFWwindow, for the user interface. */
void *weft_window_handle(const weft_window *window);
/* Dots for each of a screen of 96 dots per inch. */
double weft_window_scale(const weft_window *window);

/* Name of the driver's renderer, owned by the driver. */
const char *weft_gl_renderer(void);

#endif
