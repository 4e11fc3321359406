/* A page at true size, drawn in millimetres: the one door to cairo. The origin is the middle of the page, x right, y
 * up, as the target's frame. What is drawn is black unless it says otherwise. */
#ifndef WEFT_CAPTURE_PRINT_PAGE_H
#define WEFT_CAPTURE_PRINT_PAGE_H

#include "base/status.h"
#include "btf/session/target.h"

#include <stdbool.h>

/* ---- Sheets of paper, as printers take them. ---- */

typedef struct weft_paper {
    char name[32]; /* as printed on it */
    double width_mm, height_mm;
} weft_paper;

/* What every printer leaves empty along the edges of a page, mm. */
extern const double weft_paper_margin_mm;

/* "A4", "A3", "A5", "letter", "legal", "tabloid" (in any case) or "WxH" in mm, each side from 40 to 2000. Errors:
 * WEFT_BAD_USAGE naming --paper. */
weft_code weft_paper_parse(const char *text, weft_paper *paper, weft_error *error);

/* Sides of what can be printed on, mm. Pure. */
double weft_paper_printable_width(const weft_paper *paper);
double weft_paper_printable_height(const weft_paper *paper);

typedef struct weft_print_page weft_print_page;

typedef enum weft_print_align { WEFT_PRINT_LEFT, WEFT_PRINT_CENTRED, WEFT_PRINT_RIGHT } weft_print_align;

/* Where the format follows the extension: .pdf or .svg. Errors: WEFT_BAD_USAGE naming both. */
weft_code weft_print_page_check_name(const char *path, weft_error *error);

/* A page for a file of that name; nothing is written yet. `title` goes into a PDF. The caller ends it with
 * weft_print_page_finish or weft_print_page_abandon. Errors: WEFT_BAD_USAGE for another extension; WEFT_SYSTEM. */
weft_code weft_print_page_begin(const char *path, const weft_paper *paper, const char *title, weft_print_page **page,
                                weft_error *error);

/* Writes the page atomically, if all of the drawing went well, and frees it. The same drawing as the first of
 * a process has the same bytes: the date in a PDF is that of SOURCE_DATE_EPOCH, else 1970-01-01. Errors: WEFT_SYSTEM;
 * WEFT_BAD_USAGE where the path names no file. */
weft_code weft_print_page_finish(weft_print_page *page, weft_error *error);

/* Frees it; nothing is written. */
void weft_print_page_abandon(weft_print_page *page);

/* ---- Drawing. What fails is told by weft_print_page_finish. Lengths in mm. ---- */

/* Rectangles come together as one area, so that no seam shows where they meet. */
void weft_print_add_rectangle(weft_print_page *page, weft_rectangle rectangle);
void weft_print_fill(weft_print_page *page);

void weft_print_line(weft_print_page *page, double x0, double y0, double x1, double y1, double width_mm);
void weft_print_circle(weft_print_page *page, double x, double y, double radius_mm, double width_mm);
void weft_print_disc(weft_print_page *page, double x, double y, double radius_mm);
void weft_print_triangle(weft_print_page *page, const double corner[3][2]);

/* A line of text (UTF-8) whose baseline begins, is centred or ends at a point; `size_mm` is that of the typeface, of
 * which a capital has 0.71. `quarter_turns` counterclockwise. Returns its width. */
double weft_print_text(weft_print_page *page, double x, double y, double size_mm, weft_print_align align,
                       int quarter_turns, const char *text);

/* Of all that follows, 0: black, 1: white. */
void weft_print_grey(weft_print_page *page, double level);

/* ---- Bars with millimetre ticks, to be held against a ruler. ---- */

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
