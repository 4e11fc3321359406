/* A board to photograph for the calibration of a lens: squares of a chessboard with markers in the white ones
 * (ChArUco). Its rows are odd in number, so that all versions of OpenCV agree on its layout. */
#ifndef WEFT_CAPTURE_PRINT_LENS_BOARD_H
#define WEFT_CAPTURE_PRINT_LENS_BOARD_H

#include "capture/print/page.h"

typedef struct weft_lens_board {
    weft_paper paper;
    int columns, rows;           /* squares */
    double square_mm, marker_mm; /* sides */
    const char *dictionary;      /* of the markers, as `weft lens` calls it */
    char text[64];               /* "charuco:COLUMNSxROWS:SQUARE,MARKER:DICTIONARY", as `weft lens` takes it */
} weft_lens_board;

/* The board of 7 x 9 squares that fills the paper, in whole millimetres. Errors: WEFT_BAD_USAGE for paper on which its
 * squares would have less than 8 mm. */
weft_code weft_lens_board_for(const weft_paper *paper, weft_lens_board *board, weft_error *error);

/* Prints it to a .pdf or .svg. Errors: as of weft_print_page_begin and weft_print_page_finish; WEFT_SYSTEM. */
weft_code weft_lens_board_print(const weft_lens_board *board, const char *path, weft_error *error);

#endif
