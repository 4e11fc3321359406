/* Widgets over the picture: the one door to Dear ImGui. Immediate: every frame, between weft_ui_begin and weft_ui_end,
 * says anew what there is, and each widget returns whether the user changed its value just now. One user interface at a
 * time; the thread and the OpenGL context of the window. */
#ifndef WEFT_PLAYER_WINDOW_UI_UI_BRIDGE_H
#define WEFT_PLAYER_WINDOW_UI_UI_BRIDGE_H

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Attaches to a GLFW window whose callbacks are installed already: they are called before the widgets' own. `scale`: of
 * everything, 1 for 96 dots per inch. Errors: WEFT_SYSTEM. */
weft_code weft_ui_create(void *glfw_window, double scale, weft_error *error);
void weft_ui_free(void);

/* Widgets see one press or release of the mouse a frame, where it was then. */
void weft_ui_begin(void);
/* Draws the widgets into framebuffer 0. */
void weft_ui_end(void);

/* Whether they have not seen yet all that the mouse did. */
bool weft_ui_is_behind(void);
/* Whether a widget is held, or one that floats over the picture is open; whether the keys are a widget's. */
bool weft_ui_holds_mouse(void);
bool weft_ui_wants_keyboard(void);

/* ---- Where widgets stand: pixels from the upper left corner of the window ---- */

/* A panel that neither moves nor grows; to be ended whatever it returns. */
void weft_ui_panel_begin(const char *name, double x, double y, double width, double height);
/* A note as large as its text, at the given share of its own size from (x, y): 0.5, 0.5 centres it there. */
void weft_ui_note_begin(const char *name, double x, double y, double share_x, double share_y);
/* The note that is begun next is as large as this text at least, which has to stay until then. A note is as large as
 * its text was in the picture before, so that what grows would be cropped for as long as the next picture takes. */
void weft_ui_room_for(const char *text);
/* Text of the note that was begun wraps within a narrower width. */
void weft_ui_wrap_within(double width);
void weft_ui_panel_end(void);

typedef struct weft_ui_box {
    double x, y, width, height;
} weft_ui_box;

/* Without a meaning: a heading. */
typedef struct weft_ui_entry {
    const char *name, *meaning;
} weft_ui_entry;

/* A note in the middle of `room` with a list of names and what they mean, in two columns where that is wide enough, the
 * second from line `middle` on; its letters are smaller in a small room, and it scrolls in a smaller one. */
void weft_ui_list(const char *name, const weft_ui_entry *line, size_t count, size_t middle, const weft_ui_box *room);

/* A heading that folds what follows; whether that is shown. */
bool weft_ui_section(const char *name, bool open_at_first);
void weft_ui_same_line(void);
void weft_ui_gap(void);
/* What follows cannot be changed, until weft_ui_enable. */
void weft_ui_disable(bool disabled);
void weft_ui_enable(void);

/* ---- Widgets; labels stand left of them ---- */

void weft_ui_heading(const char *text);
void weft_ui_text(const char *text);
void weft_ui_dim_text(const char *text);
/* A patch of that colour (0xRRGGBBAA) and what it means. */
void weft_ui_swatch(uint32_t colour, const char *meaning);
void weft_ui_value(const char *label, const char *value);
bool weft_ui_button(const char *label);
/* One of several lines to choose from, with all of it under the pointer; `whole` differs from that of the others. */
bool weft_ui_entry_chosen(const char *label, const char *whole);
bool weft_ui_toggle(const char *label, bool *value);
/* `low`, `high`: of what the user may choose; a value beyond them stays until then. `format` as printf takes it for one
 * double; `logarithmic` needs 0 < low. */
bool weft_ui_slider(const char *label, double *value, double low, double high, const char *format, bool logarithmic);
bool weft_ui_angle(const char *label, double *value_rad, double low_deg, double high_deg);
bool weft_ui_whole(const char *label, int *value, int low, int high);
/* Typed, or stepped by one: for ranges too wide for a slider. */
bool weft_ui_whole_input(const char *label, int *value, int low, int high);
/* One of `count` names, side by side; those with allowed[i] false cannot be chosen (NULL: all can). */
bool weft_ui_choice(const char *label, int *value, const char *const *name, const bool *allowed, int count);
bool weft_ui_colour(const char *label, double rgb[3]);

/* ---- Drawing within a panel ---- */

/* Room for a drawing, with its upper left corner and the pointer, in the window's pixels. */
typedef struct weft_ui_area {
    double x, y, pointer_x, pointer_y;
    bool hovered, dragged;
} weft_ui_area;

/* Where the next widget will stand. */
weft_ui_area weft_ui_here(void);
weft_ui_area weft_ui_drawing(const char *name, double width, double height);
/* An OpenGL texture with alpha, its first row at the bottom. */
void weft_ui_picture(unsigned texture, double width, double height);
/* Colours are 0xRRGGBBAA. */
void weft_ui_disc(double x, double y, double radius, uint32_t colour);
void weft_ui_ring(double x, double y, double radius, double thickness, uint32_t colour);
void weft_ui_label(double x, double y, uint32_t colour, const char *text);

/* ---- Hints: one line on a widget of the panel, shown where the pointer rests on it. Pure. ---- */

/* NULL where the label says it all. A key that does the same stands in brackets at the end. */
const char *weft_hint_of(const char *label);

/* All of them, for the tests: that of `number`, or NULL beyond the last; its label in *label. */
const char *weft_hint_at(size_t number, const char **label);

#ifdef __cplusplus
}
#endif
#endif
