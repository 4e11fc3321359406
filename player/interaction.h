/* What mouse and keys do to a scene. Pure: no window, no OpenGL. */
#ifndef WEFT_PLAYER_INTERACTION_H
#define WEFT_PLAYER_INTERACTION_H

#include "player/player.h"

typedef enum weft_drag { WEFT_DRAG_NONE, WEFT_DRAG_ORBIT, WEFT_DRAG_LIGHT } weft_drag;

typedef struct weft_interaction {
    weft_scene scene;
    bool available[WEFT_MODE_COUNT];
    int width, height; /* of the window, pixels */
    weft_drag drag;
    bool drag_moves_light; /* also with the left button */
    double x, y;           /* of the pointer at the last event */
    /* What the caller takes note of and resets: */
    bool changed; /* the picture is out of date */
    bool wants_screenshot, wants_quit;
    const char *wants_mesh; /* name of a built-in mesh, or NULL */
} weft_interaction;

/* One line for each thing mouse and keys do. */
extern const char weft_interaction_help[];

/* Button, press or release, and whether shift is held. The left button orbits, the right one (or the left with shift,
 * or after key L) moves the light. */
void weft_interaction_press(weft_interaction *interaction, int button, bool pressed, bool shift, double x, double y);

/* A full width is one turn; a full height is half a turn. */
void weft_interaction_move(weft_interaction *interaction, double x, double y);

/* Steps of the wheel; away from the user comes closer. */
void weft_interaction_scroll(weft_interaction *interaction, double steps);

/* A GLFW key code. */
void weft_interaction_key(weft_interaction *interaction, int key);

#endif
