/* The widgets of the window: the panel on the left of the picture, and notes over it. */
#ifndef WEFT_PLAYER_WINDOW_PANEL_H
#define WEFT_PLAYER_WINDOW_PANEL_H

#include "player/window/application_state.h"

/* Pixels that the panel takes from the left of the window. */
int weft_panel_width(const weft_application *application);

/* All widgets of one frame; changes the interaction and its scene. `width`, `height`: of the window. */
void weft_panel_show(weft_application *application, int width, int height);

/* Shows what has become of a changed weave. */
void weft_panel_follow_weave(weft_application *application);

/* ---- Its parts ---- */

/* Over the picture, which begins at `left`: what goes on, what was done, and the list of keys. */
void weft_panel_show_notes(const weft_application *application, int left, int width, int height);

/* The section on what lies under the pointer. */
void weft_panel_show_probe(const weft_application *application);

/* The section on the weave that is shown. */
void weft_panel_show_weave(weft_application *application);

/* The section to open files from: the folder of the one that is shown. */
void weft_panel_show_files(weft_application *application);

/* Where a direction lies on a disc of the upper hemisphere whose areas are solid angles: the radius is sin(theta / 2)
 * sqrt(2). x, y: the upper left corner of the disc. */
void weft_panel_place(weft_vec3 direction, double x, double y, double radius, double *at_x, double *at_y);

#endif
