/* The scale of a signed difference, drawn into it as differences. */
#ifndef WEFT_PLAYER_DRAW_LEGEND_H
#define WEFT_PLAYER_DRAW_LEGEND_H

#include "player/gl/label.h"
#include "player/scene/scene.h"

/* In the lower left corner of a picture of width x height pixels that holds differences (the framebuffer in use):
 * colours from -WEFT_SCENE_FULL_DIFFERENCE to it, and in words what they say of `second`. Nothing where the picture is
 * too small. Errors: WEFT_SYSTEM. */
weft_code weft_legend_draw(weft_labels *labels, int width, int height, weft_mode second, weft_error *error);

#endif
