/* A bitmap font for labels: printable ASCII, 5 x 7 pixels in cells of 6 x 9. */
#ifndef WEFT_PLAYER_FONT_H
#define WEFT_PLAYER_FONT_H

#include <stdint.h>

enum {
    WEFT_FONT_FIRST = 32,
    WEFT_FONT_COUNT = 95,
    WEFT_FONT_ROWS = 7,
    WEFT_FONT_COLUMNS = 5,
    WEFT_FONT_CELL_WIDTH = 6,
    WEFT_FONT_CELL_HEIGHT = 9
};

/* Rows from the top, five pixels each, the leftmost in bit 4. */
extern const uint8_t weft_font[WEFT_FONT_COUNT][WEFT_FONT_ROWS];

#endif
