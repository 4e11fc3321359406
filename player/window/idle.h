/* When a window need not be shown again: nothing has happened since it was shown last. */
#ifndef WEFT_PLAYER_WINDOW_IDLE_H
#define WEFT_PLAYER_WINDOW_IDLE_H

#include <stdbool.h>

typedef struct weft_idle {
    double stirred_s; /* when something happened last */
    double note_ends_s;
    bool had_note;
} weft_idle;

/* What goes on in a window. */
typedef struct weft_stir {
    bool has_events;    /* of the user or the desktop, since the last time */
    bool is_busy;       /* drawing, reading, or waiting for a weave; a text is typed, whose cursor blinks */
    double note_ends_s; /* when what was told last goes away by itself */
} weft_stir;

/* Whether the window is at rest: nothing goes on, and what went on last is so long ago that a hint which comes late,
 * over a widget under the pointer, has come. A note that comes or goes is something. Called once a turn of the loop,
 * `now_s` by weft_now_s. */
bool weft_idle_at(weft_idle *idle, const weft_stir *stir, double now_s);

#endif
