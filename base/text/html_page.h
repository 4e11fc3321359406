/* A report: one HTML page with pictures beside it, in a folder. All reports of Weft look alike. Besides what the
 * functions below write, its style knows
 *
 *     <div class="tiles">          the few numbers that matter most, by weft_page_tile
 *     <p class="note">             an explanation, smaller
 *     <div class="row">            figures side by side; "row even": in columns of one width that fill the page
 *     <div class="gallery">        cards; each is a <figure> with a <div> of up to three pictures and a <figcaption>
 *     <table class="long">         many rows and columns: smaller, and the heading stays in sight
 *     <td class="text">            a cell of words, at the left; a table's first column is at the left anyway;
 *                                  "text reason": a sentence, which is not squeezed
 *     <tr class="bad">, "weak"     a row that reports a failure, or something to look at; also <figure class="bad">
 *     <svg class="plot">           drawn in the colours of the page, as by base/text/chart.h, 560 units wide, 760 with
 *                                  a legend; "plot disc": small, without a frame;
 *                                  <div class="plots"> holds two or three
 *     <div class="pairs">          rows of two small pictures side by side
 *     class="colour0" to "colour8" what belongs together
 *
 * It is light or dark as the reader's system is. Pictures enlarge at a click; those of one row, figure or gallery may
 * then be wiped one against the other. */
#ifndef WEFT_BASE_TEXT_HTML_PAGE_H
#define WEFT_BASE_TEXT_HTML_PAGE_H

#include "base/picture/image.h"
#include "base/status.h"

#include <stdio.h>

/* A page being made. `html` takes markup; text from outside goes through weft_page_text. Freed by finish or abandon. */
typedef struct weft_page {
    char *folder;
    FILE *html;
    char *bytes; /* what was written to html so far, after a flush */
    size_t size;
} weft_page;

/* Makes the folder (an existing one is fine) and begins the page. Errors: WEFT_SYSTEM. */
weft_code weft_page_begin(const char *folder, const char *title, weft_page *page, weft_error *error);

/* Writes text in which nothing is markup: & < > " and ' are escaped, so that it may also stand in an attribute, in
 * quotation marks of either kind. */
void weft_page_text(weft_page *page, const char *text);

/* Writes NAME.png (values 0..1 as encoded) into the folder and a figure with a caption (text) that shows it `width`
 * pixels wide. */
weft_code weft_page_picture(weft_page *page, const char *name, const weft_image *image, int width, const char *caption,
                            weft_error *error);

/* A large number or word, formatted, with what it says below it (text); stands in <div class="tiles">. */
void weft_page_tile(weft_page *page, const char *label, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* The headings of a table's columns, or of a part of it: text, with "|" between one and the next; ':' before one of
 * words, which stands at the left as its cells do. */
void weft_page_columns(weft_page *page, const char *headings);

/* A row of a table of two columns: text and a formatted number or text. */
void weft_page_fact(weft_page *page, const char *name, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Writes index.html atomically: the page exists once all its pictures do. Frees the page, also on failure. */
weft_code weft_page_finish(weft_page *page, weft_error *error);
void weft_page_abandon(weft_page *page);

#endif
