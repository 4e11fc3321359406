/* What mouse and keys do: one table, for the hands, the list in the window and the page in docs/. Pure: no window, no
 * OpenGL. */
#ifndef WEFT_PLAYER_WINDOW_KEYS_H
#define WEFT_PLAYER_WINDOW_KEYS_H

#include "player/window/interaction.h"

#include <stddef.h>

/* A line of the table. Without a meaning its name is a heading; without a name it is another key of the line above. */
typedef struct weft_key {
    const char *name, *meaning;
    int code;                                        /* GLFW's; 0: no key */
    bool with_control;                               /* only while Ctrl is held; other keys only while it is not */
    bool repeats;                                    /* while it is held */
    void (*press)(weft_interaction *, double value); /* or NULL */
    double value;                                    /* that `press` gets: which mode, how far */
    size_t sets, toggles;                            /* offsets in weft_interaction of a bool so changed; 0: none */
    void (*release)(weft_interaction *);             /* or NULL */
} weft_key;

/* The table, of *count lines in the order they are read; static storage. */
const weft_key *weft_keys(size_t *count);

/* A GLFW key code and the modifiers held. `again`: the key is held and repeats. */
void weft_keys_press(weft_interaction *interaction, int code, int modifiers, bool again);
void weft_keys_release(weft_interaction *interaction, int code);

#endif
