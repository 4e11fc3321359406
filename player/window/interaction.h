/* What the user does to a scene. Pure: no window, no OpenGL. */
#ifndef WEFT_PLAYER_WINDOW_INTERACTION_H
#define WEFT_PLAYER_WINDOW_INTERACTION_H

#include "player/scene/scene.h"

typedef enum weft_drag {
    WEFT_DRAG_NONE,
    WEFT_DRAG_ORBIT,
    WEFT_DRAG_PAN,
    WEFT_DRAG_LIGHT,
    WEFT_DRAG_POINT, /* the light goes where the pointer is */
    WEFT_DRAG_DIVIDER
} weft_drag;

typedef struct weft_interaction {
    weft_scene scene, start; /* now, and as it was at first */
    bool available[WEFT_MODE_COUNT], has_environment, has_relief, is_reading;
    int width, height; /* of the picture, pixels */
    weft_drag drag;
    bool drag_moves_light; /* also with the left button and the arrow keys */
    bool points_light;     /* the left button then moves it to the pointer: the picture is a map of the hemisphere that
                              the camera looks into */
    bool turns;            /* by itself */
    double x, y;           /* of the pointer at the last event, pixels from the picture's upper left corner */
    weft_mode before;      /* shown before the last flip */
    bool peeks;            /* raw alone is shown for a moment, instead of the panes of: */
    weft_scene unpeeked;
    bool shows_help, shows_panel, full_screen;
    /* What the caller takes note of and resets: */
    bool changed; /* the picture is out of date */
    bool wants_screenshot, wants_quit, wants_reload, wants_undo, wants_redo;
    const char *wants_file;         /* to be opened, or NULL */
    const char *wants_mesh;         /* name of a built-in mesh, or NULL */
    const char *wants_surroundings; /* name of a built-in environment, "none", or NULL */
    char message[96];               /* what a key did, to be told; or "" */
} weft_interaction;

/* Button, press or release, and the GLFW modifiers held. */
void weft_interaction_press(weft_interaction *interaction, int button, bool pressed, int modifiers, double x, double y);

/* A full width is one turn; a full height is half a turn. */
void weft_interaction_move(weft_interaction *interaction, double x, double y);

/* Steps of the wheel; away from the user comes closer. */
void weft_interaction_scroll(weft_interaction *interaction, double steps);

/* ---- What keys and widgets share ---- */

/* That mode alone, if there is data for it. */
void weft_interaction_show(weft_interaction *interaction, weft_mode mode);

/* Side by side: all modes there are. Wipe and difference: the first two of them. */
void weft_interaction_lay_out(weft_interaction *interaction, weft_layout layout);

/* Panes: the mode shown before, or any other. Wipe and difference: the two swapped. */
void weft_interaction_flip(weft_interaction *interaction);

/* Raw alone, if it is there, until weft_interaction_end_peek; that does nothing unless it is shown so. */
void weft_interaction_peek(weft_interaction *interaction);
void weft_interaction_end_peek(weft_interaction *interaction);

/* As a drag would turn the cloth, or the light where plain drags move that. */
void weft_interaction_turn(weft_interaction *interaction, double across_rad, double down_rad);

#endif
