/* A page at true size, drawn in millimetres: the one door to cairo. The origin is the middle of the page, x right, y
 * up, as the target's frame. What is drawn is black unless it says otherwise. */
#ifndef WEFT_CAPTURE_PRINT_PAGE_H
#define WEFT_CAPTURE_PRINT_PAGE_H

#include "base/status.h"
#include "btf/session/target.h"
#include "capture/print/paper.h"

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

#endif
