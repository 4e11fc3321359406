#include "capture/print/sheets.h"

#include "capture/print/dictionary_bridge.h"
#include "capture/print/page.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

enum { COLUMNS = 7, ROWS = 9 };

static const double smallest_square_mm = 8, words_mm = 14;

weft_code weft_lens_board_for(const weft_paper *paper, weft_lens_board *board, weft_error *error)
{
    double across = weft_paper_printable_width(paper) / COLUMNS;
    double along = (weft_paper_printable_height(paper) - words_mm) / ROWS;
    double square = floor(fmin(across, along));
    if (square < smallest_square_mm)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "--paper %s is too small for a lens board: its squares have at least %g mm", paper->name,
                         smallest_square_mm);
    *board = (weft_lens_board){*paper, COLUMNS, ROWS, square, floor(0.75 * square), "5X5_100", ""};
    snprintf(board->text, sizeof board->text, "charuco:%dx%d:%g,%g:%s", COLUMNS, ROWS, square, board->marker_mm,
             board->dictionary);
    return WEFT_OK;
}

/* Of the square in a column and a row from the top; the words stand below the board. */
static weft_rectangle square_at(const weft_lens_board *b, int column, int row)
{
    double x = (column - b->columns / 2.0) * b->square_mm;
    double y = (b->rows * b->square_mm + words_mm) / 2 - (row + 1) * b->square_mm;
    return (weft_rectangle){x, y, x + b->square_mm, y + b->square_mm};
}

static weft_code add_marker(const weft_lens_board *b, weft_print_page *page, weft_rectangle square, int id,
                            weft_error *error)
{
    uint8_t ink[WEFT_BOARD_MARKER_CELLS][WEFT_BOARD_MARKER_CELLS];
    double cell = b->marker_mm / WEFT_BOARD_MARKER_CELLS, edge = (b->square_mm - b->marker_mm) / 2;
    WEFT_TRY(weft_board_marker(id, ink, error));
    for (int row = 0; row < WEFT_BOARD_MARKER_CELLS; row++) {
        for (int column = 0; column < WEFT_BOARD_MARKER_CELLS; column++) {
            double x = square.x0 + edge + column * cell, y = square.y1 - edge - row * cell;
            if (ink[row][column])
                weft_print_add_rectangle(page, (weft_rectangle){x, y - cell, x + cell, y});
        }
    }
    return WEFT_OK;
}

/* Black squares from the top left one, markers in the white ones, counted in rows from the top. */
static weft_code draw_squares(const weft_lens_board *b, weft_print_page *page, weft_error *error)
{
    int id = 0;
    for (int row = 0; row < b->rows; row++) {
        for (int column = 0; column < b->columns; column++) {
            weft_rectangle square = square_at(b, column, row);
            if ((row + column) % 2 == 0)
                weft_print_add_rectangle(page, square);
            else
                WEFT_TRY(add_marker(b, page, square, id++, error));
        }
    }
    weft_print_fill(page);
    return WEFT_OK;
}

static void draw_words(const weft_lens_board *b, weft_print_page *page)
{
    char text[128];
    double left = -b->columns * b->square_mm / 2, scale = fmin(1, b->square_mm / 26), size = 2.9 * scale;
    double top = square_at(b, 0, b->rows - 1).y0, length = b->columns * b->square_mm > 130 ? 50 : 20;
    weft_ruler ruler = {-left - length / 2 - 3 * scale, top - 11 * scale, false, length, scale};
    weft_ruler_draw(&ruler, page);
    snprintf(text, sizeof text, "Weft lens board   %s", b->text);
    weft_print_text(page, left, top - 5 * scale, 1.15 * size, WEFT_PRINT_LEFT, 0, text);
    weft_print_text(page, left, top - 9 * scale, size, WEFT_PRINT_LEFT, 0,
                    "Print on matt paper at 100 %, glue it flat on a plate.");
    snprintf(text, sizeof text, "If the bar is not %g mm, the lens is right all the same; distances are not.", length);
    weft_print_text(page, left, top - 13 * scale, size, WEFT_PRINT_LEFT, 0, text);
}

weft_code weft_lens_board_print(const weft_lens_board *board, const char *path, weft_error *error)
{
    weft_print_page *page;
    WEFT_TRY(weft_print_page_begin(path, &board->paper, board->text, &page, error));
    weft_code code = draw_squares(board, page, error);
    if (code != WEFT_OK) {
        weft_print_page_abandon(page);
        return code;
    }
    draw_words(board, page);
    return weft_print_page_finish(page, error);
}
