/* The frame of a picture that moves, the only one on its canvas. */
#ifndef WEFT_PLAYER_DRAW_MOVING_H
#define WEFT_PLAYER_DRAW_MOVING_H

#include "player/draw/canvas.h"
#include "player/draw/pace.h"
#include "player/draw/player.h"

/* Draws it as `pace` says: with fewer pixels it is enlarged, but for its words. What the canvas had is forgotten.
 * Errors: those of weft_player_draw. */
weft_code weft_player_draw_moving(weft_player *player, const weft_scene *scene, const weft_pace *pace,
                                  weft_canvas *canvas, weft_error *error);

#endif
