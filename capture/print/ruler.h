/* Bars with millimetre ticks, to be held against a ruler. */
#ifndef WEFT_CAPTURE_PRINT_RULER_H
#define WEFT_CAPTURE_PRINT_RULER_H

#include "capture/print/page.h"

#include <stdbool.h>

typedef struct weft_ruler {
    double x, y;      /* of its middle on the line that the ticks stand on, mm */
    bool upright;     /* along y, ticks toward +x; else along x, ticks toward +y */
    double length_mm; /* between the middles of the first and the last tick, a multiple of 10 */
    double scale;     /* of ticks and numbers */
} weft_ruler;

/* What it covers, numbers included. Pure. */
weft_rectangle weft_ruler_outline(const weft_ruler *ruler);

void weft_ruler_draw(const weft_ruler *ruler, weft_print_page *page);

#endif
