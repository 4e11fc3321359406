/* What a reach takes note of. Private to edit/prune. */
#ifndef WEFT_EDIT_PRUNE_REACH_MARKS_H
#define WEFT_EDIT_PRUNE_REACH_MARKS_H

#include "edit/prune/camera_span.h"
#include "edit/prune/reach.h"

/* All texels that a pixel between the levels may read whose texture coordinates lie in a box; a border around it, in
 * materials, is read, too. */
typedef struct weft_reach_box {
    double low[2], high[2];
    double border[2];
} weft_reach_box;
void weft_reach_mark_texels(weft_reach *reach, const weft_reach_box *box, int first_level, int last_level);

/* A cap of views and one of lights, seen together, in the axes of the surface. What of the lights lies below the
 * horizon is left out; views are held above it as a player holds them. */
void weft_reach_mark_pair(weft_reach *reach, const weft_direction_cap *view, const weft_direction_cap *light);

/* A cap of views whose lights do not matter; and then light from everywhere for all views. */
void weft_reach_mark_view(weft_reach *reach, const weft_direction_cap *view);
void weft_reach_light_all(weft_reach *reach);

#endif
