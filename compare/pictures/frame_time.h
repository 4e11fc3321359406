/* How long the player takes for a frame. */
#ifndef WEFT_COMPARE_PICTURES_FRAME_TIME_H
#define WEFT_COMPARE_PICTURES_FRAME_TIME_H

#include "player/draw/player.h"

/* Milliseconds of one frame of the scene, width x height pixels: two pictures of different numbers of frames, whose
 * difference leaves out what they share (buffers, reading back); of each the shortest of three tries, which other work
 * on the machine disturbs least. 0 where that says nothing. Errors: those of drawing. */
weft_code weft_frame_time_measure(weft_player *player, const weft_scene *scene, int width, int height, double *frame_ms,
                                  weft_error *error);

#endif
