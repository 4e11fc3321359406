/* What mouse and keys do to a scene. Pure: no window, no OpenGL. */
#ifndef WEFT_PLAYER_INTERACTION_H
#define WEFT_PLAYER_INTERACTION_H

#include "player/scene.h"

typedef enum weft_drag { WEFT_DRAG_NONE, WEFT_DRAG_ORBIT, WEFT_DRAG_PAN, WEFT_DRAG_LIGHT, WEFT_DRAG_DIVIDER } weft_drag;

typedef struct weft_interaction {
    weft_scene scene;
    bool available[WEFT_MODE_COUNT];
    int width, height; /* of the picture, pixels */
    weft_drag drag;
    bool drag_moves_light; /* also with the left button */
    double x, y;           /* of the pointer at the last event, pixels from the picture's upper left corner */
    weft_mode before;      /* shown before the last flip */
    bool shows_help, shows_panel;
    /* What the caller takes note of and resets: */
    bool changed; /* the picture is out of date */
    bool wants_screenshot, wants_quit, wants_reload;
    const char *wants_mesh; /* name of a built-in mesh, or NULL */
} weft_interaction;

/* What the keys and the mouse do, in words: `meaning` NULL ends the list. */
typedef struct weft_interaction_line {
    const char *key, *meaning;
} weft_interaction_line;

/* The list has static storage. */
const weft_interaction_line *weft_interaction_help(void);

/* Button, press or release, and the GLFW modifiers held. */
void weft_interaction_press(weft_interaction *interaction, int button, bool pressed, int modifiers, double x, double y);

/* A full width is one turn; a full height is half a turn. */
void weft_interaction_move(weft_interaction *interaction, double x, double y);

/* Steps of the wheel; away from the user comes closer. */
void weft_interaction_scroll(weft_interaction *interaction, double steps);

/* A GLFW key code. */
void weft_interaction_key(weft_interaction *interaction, int key);

/* ---- What keys and widgets share ---- */

/* That mode alone, if there is data for it. */
void weft_interaction_show(weft_interaction *interaction, weft_mode mode);

/* Side by side: all modes there are. Wipe and difference: the first two of them. */
void weft_interaction_lay_out(weft_interaction *interaction, weft_layout layout);

/* Angle of `theta` limited to what a light may have. */
void weft_interaction_turn_light(weft_angles *light, double phi_rad, double theta_rad);

#endif
