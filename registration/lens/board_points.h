/* The points of a board in a photograph. */
#ifndef WEFT_REGISTRATION_LENS_BOARD_POINTS_H
#define WEFT_REGISTRATION_LENS_BOARD_POINTS_H

#include "registration/lens/board.h"

#include <stdint.h>

typedef struct weft_board_point {
    double board_mm[2]; /* on the board */
    double pixel[2];    /* origin at the centre of the top left pixel */
} weft_board_point;

/* Finds the points of the board in an 8-bit grey picture, to a fraction of a pixel. `point` has room for
 * weft_board_point_limit. *count is 0 where the board is not seen. Errors: WEFT_SYSTEM. */
weft_code weft_board_find(const weft_board *board, const uint8_t *grey, int width, int height, weft_board_point *point,
                          int *count, weft_error *error);

/* How wide the edges around the points are, in pixels: grey range over steepest slope, in the direction in which it is
 * least (a shake blurs one direction only); the median of the points. 0 without points. Pure. */
double weft_board_edge_width(const uint8_t *grey, int width, int height, const weft_board_point *point, int count);

#endif
