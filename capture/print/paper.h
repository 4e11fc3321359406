/* Sheets of paper, as printers take them. */
#ifndef WEFT_CAPTURE_PRINT_PAPER_H
#define WEFT_CAPTURE_PRINT_PAPER_H

#include "base/status.h"

typedef struct weft_paper {
    char name[32]; /* as printed on it */
    double width_mm, height_mm;
} weft_paper;

/* What every printer leaves empty along the edges of a page, mm. */
extern const double weft_paper_margin_mm;

/* "A4", "letter" (in any case) or "WxH" in mm, each side from 40 to 2000. Errors: WEFT_BAD_USAGE naming --paper. */
weft_code weft_paper_parse(const char *text, weft_paper *paper, weft_error *error);

/* Sides of what can be printed on, mm. Pure. */
double weft_paper_printable_width(const weft_paper *paper);
double weft_paper_printable_height(const weft_paper *paper);

#endif
