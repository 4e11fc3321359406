/* The target (btf/session/target.h) as a sheet out of a printer, at true size, with what a hand needs to know. */
#ifndef WEFT_CAPTURE_PRINT_TARGET_SHEET_H
#define WEFT_CAPTURE_PRINT_TARGET_SHEET_H

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

#endif
