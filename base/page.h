/* One HTML page with pictures beside it, in a folder. */
#ifndef WEFT_BASE_PAGE_H
#define WEFT_BASE_PAGE_H

#include "base/image.h"
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

/* Text with the characters of markup escaped. */
void weft_page_text(weft_page *page, const char *text);

/* Writes NAME.png (values 0..1 as encoded) into the folder and a figure with a caption (text) that shows it `width`
 * pixels wide. */
weft_code weft_page_picture(weft_page *page, const char *name, const weft_image *image, int width, const char *caption,
                            weft_error *error);

/* A row of a table of two columns: text and a formatted number or text. */
void weft_page_fact(weft_page *page, const char *name, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Writes index.html atomically: the page exists once all its pictures do. Frees the page, also on failure. */
weft_code weft_page_finish(weft_page *page, weft_error *error);
void weft_page_abandon(weft_page *page);

#endif
