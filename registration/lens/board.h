/* Boards that are photographed to calibrate a lens. */
#ifndef WEFT_REGISTRATION_LENS_BOARD_H
#define WEFT_REGISTRATION_LENS_BOARD_H

#include "base/status.h"

#include <stdint.h>

typedef enum weft_board_kind {
    WEFT_BOARD_PLATE,      /* the target (btf/session/target.h) */
    WEFT_BOARD_CHESSBOARD, /* inner corners */
    WEFT_BOARD_CHARUCO,    /* squares of a chessboard, markers in the white ones */
    WEFT_BOARD_MARKERS     /* a grid of markers, or one */
} weft_board_kind;

typedef struct weft_board {
    weft_board_kind kind;
    int columns, rows;   /* inner corners, squares or markers */
    double size_mm;      /* of the opening, a square or a marker */
    double second_mm;    /* charuco: side of a marker; markers: gap between two */
    char dictionary[32]; /* of the markers, as registration/pose/opencv_bridge.h has them */
    char text[128];      /* as it was given */
} weft_board;

/* "KIND:COLUMNSxROWS:SIZES_MM[:DICTIONARY]":
 *   plate:OPENING
 *   chessboard:COLUMNSxROWS:SQUARE               inner corners
 *   charuco:COLUMNSxROWS:SQUARE,MARKER[:DICTIONARY]    squares; 4X4_50 where it is not said; DICT_4X4_50 is the same
 *   aruco:COLUMNSxROWS:MARKER,GAP[:DICTIONARY]         markers; 4X4_50
 *   apriltag:COLUMNSxROWS:MARKER[,GAP][:DICTIONARY]    tags; 36h11; 1x1 is any one tag
 * Errors: WEFT_BAD_USAGE naming --board and what is wrong. */
weft_code weft_board_parse(const char *text, weft_board *board, weft_error *error);

/* The most points that a photograph of it can show. Pure. */
int weft_board_point_limit(const weft_board *board);

/* ---- The points of a board in a photograph ---- */

typedef struct weft_board_point {
    double board_mm[2]; /* on the board */
    double pixel[2];    /* origin at the centre of the top left pixel */
} weft_board_point;

/* Finds the points of the board in an 8-bit grey picture, to a fraction of a pixel. `point` has room for
 * weft_board_point_limit. *count is 0 where the board is not seen. Errors: WEFT_SYSTEM. */
weft_code weft_board_find(const weft_board *board, const uint8_t *grey, int width, int height, weft_board_point *point,
                          int *count, weft_error *error);

#endif
