/* The frames of a window: interactive ones while something changes, and those whose mean is the converged picture. */
#ifndef WEFT_PLAYER_DRAW_INTERACTIVE_H
#define WEFT_PLAYER_DRAW_INTERACTIVE_H

#include "player/draw/pace.h"
#include "player/draw/player.h"

/* Draws an interactive frame as `pace` says. A smaller frame is enlarged, its labels are not. Clears the canvas.
 * Errors: those of weft_player_draw. */
weft_code weft_player_draw_interactive(weft_player *player, const weft_scene *scene, const weft_pace *pace,
                                       weft_canvas *canvas, weft_error *error);

/* Sampling of frame number `frame`, from 0: the first lies on the centres of the pixels, any first few are evenly
 * distributed over them. Pure. */
weft_sampling weft_sampling_converging(int frame);

#endif
