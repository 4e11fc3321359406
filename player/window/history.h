/* What the user changed, to take it back and do it again: lights, what is shown and how, and the weave. The camera
 * stays where it is. */
#ifndef WEFT_PLAYER_WINDOW_HISTORY_H
#define WEFT_PLAYER_WINDOW_HISTORY_H

#include "player/scene/scene.h"
#include "player/window/weave_edit.h"

enum { WEFT_HISTORY_LENGTH = 64 };

/* A scene, and the numbers of the weave that was edited in it. */
typedef struct weft_history_state {
    weft_scene scene;
    int weave_reads; /* weft_weave_edit.reads */
    int yarn_count;  /* 0: there was no weave to edit */
    weft_yarn *yarn;
    weft_real fineness, period, inclination_noise_deg[4];
} weft_history_state;

/* {0} is empty. Freed with weft_history_free. */
typedef struct weft_history {
    weft_history_state state[WEFT_HISTORY_LENGTH]; /* the oldest first */
    int count, now;                                /* states; the one that is shown, or was before the last change */
} weft_history;

void weft_history_free(weft_history *history);

/* To be called before each thing that the user does: keeps what is shown, if it was changed since. Of more than
 * WEFT_HISTORY_LENGTH states the oldest is forgotten, and without memory the weave of this one. */
void weft_history_note(weft_history *history, const weft_scene *scene, const weft_weave_edit *weave);

/* One state back, or forward again. False where there is none. *weave_changed: the player has yet to show the weave
 * (weft_weave_edit_ask). A weave that was read since stays as it is. */
bool weft_history_undo(weft_history *history, weft_scene *scene, weft_weave_edit *weave, bool *weave_changed);
bool weft_history_redo(weft_history *history, weft_scene *scene, weft_weave_edit *weave, bool *weave_changed);

#endif
