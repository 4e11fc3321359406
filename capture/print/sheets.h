/* What `weft target` prints, at true size: the target (btf/session/target.h) with notes for whoever photographs it, and
 * a board for the calibration of a lens. */
#ifndef WEFT_CAPTURE_PRINT_SHEETS_H
#define WEFT_CAPTURE_PRINT_SHEETS_H

#include "capture/print/page.h"

typedef struct weft_target_sheet_settings {
    weft_paper paper;
    double opening_mm; /* 0: 50, or the largest that fits where that is less */
    double ball_mm;    /* diameter of the mirror balls; 0: none */
    double pin_mm;     /* height of the pin; 0: none */
} weft_target_sheet_settings;

extern const double weft_target_default_opening_mm, weft_target_smallest_opening_mm;

/* The largest opening whose sheet fits what can be printed on, rounded down to 0.1 mm. Pure. */
double weft_target_largest_opening(const weft_paper *paper);

/* Fills in the opening. Errors: WEFT_BAD_USAGE where the opening, the balls or the bars for the ruler do not fit the
 * paper, naming the largest that does. The bars keep clear of markers, balls and the ring. */
weft_code weft_target_sheet_check(weft_target_sheet_settings *settings, weft_error *error);

/* Prints a sheet that was checked to a .pdf or .svg. Errors: as of weft_print_page_begin and weft_print_page_finish. */
weft_code weft_target_sheet_print(const weft_target_sheet_settings *settings, const char *path, weft_error *error);

/* ---- The board: squares of a chessboard with markers in the white ones (ChArUco). Its rows are odd in number, so that
 * all versions of OpenCV agree on its layout. ---- */

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
