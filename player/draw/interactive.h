/* The frames of a window: interactive ones while something changes, and those whose mean is the converged picture. */
#ifndef WEFT_PLAYER_DRAW_INTERACTIVE_H
#define WEFT_PLAYER_DRAW_INTERACTIVE_H

#include "player/draw/pace.h"
#include "player/draw/player.h"

/* Draws it as `pace` says: with fewer pixels it is enlarged, but for its words. What the canvas had is forgotten.
 * Errors: those of weft_player_draw. */
weft_code weft_player_draw_moving(weft_player *player, const weft_scene *scene, const weft_pace *pace,
                                  weft_canvas *canvas, weft_error *error);

/* Of the frame-th of them, from 0: the first lies on the middles of the pixels, any first few spread evenly over them.
 */
weft_sampling weft_sampling_at_rest(int frame);

#endif
