/* The frames whose mean is a picture at rest in a window. Pure: no OpenGL. */
#ifndef WEFT_PLAYER_DRAW_RESTING_H
#define WEFT_PLAYER_DRAW_RESTING_H

#include "player/draw/player.h"

/* Of the frame-th of them, from 0: the first lies on the middles of the pixels, any first few spread evenly over them.
 */
weft_sampling weft_sampling_at_rest(int frame);

#endif
