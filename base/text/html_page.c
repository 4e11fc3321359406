#include "base/text/html_page.h"

#include "base/atomic_file.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* base/text/page/page.css and page.js, in the program. */
extern const char weft_page_page_css[], weft_page_page_js[];

weft_code weft_page_begin(const char *folder, const char *title, weft_page *page, weft_error *error)
{
    *page = (weft_page){0};
    WEFT_TRY(weft_make_folder(folder, error));
    page->folder = strdup(folder);
    page->html = open_memstream(&page->bytes, &page->size);
    if (!page->folder || !page->html) {
        weft_page_abandon(page);
        return weft_fail_memory(error, "page", strlen(folder));
    }
    fputs("<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" "
          "content=\"width=device-width\">\n<title>",
          page->html);
    weft_page_text(page, title);
    fprintf(page->html, "</title>\n<style>\n%s</style>\n<h1>", weft_page_page_css);
    weft_page_text(page, title);
    fputs("</h1>\n", page->html);
    return WEFT_OK;
}

void weft_page_text(weft_page *page, const char *text)
{
    for (; *text; text++) {
        switch (*text) {
        case '<':
            fputs("&lt;", page->html);
            break;
        case '>':
            fputs("&gt;", page->html);
            break;
        case '&':
            fputs("&amp;", page->html);
            break;
        case '"':
            fputs("&quot;", page->html);
            break;
        case '\'':
            fputs("&#39;", page->html);
            break;
        default:
            fputc(*text, page->html);
        }
    }
}

weft_code weft_page_picture(weft_page *page, const char *name, const weft_image *image, int width, const char *caption,
                            weft_error *error)
{
    char *path;
    if (asprintf(&path, "%s/%s.png", page->folder, name) < 0)
        return weft_fail_memory(error, "path", strlen(name));
    weft_code code = weft_image_write(path, image, caption, error);
    free(path);
    WEFT_TRY(code);
    fprintf(page->html, "<figure><a href=\"%s.png\"><img src=\"%s.png\" width=\"%d\" alt=\"", name, name, width);
    weft_page_text(page, caption);
    fputs("\"></a><figcaption>", page->html);
    weft_page_text(page, caption);
    fputs("</figcaption></figure>\n", page->html);
    return WEFT_OK;
}

/* A formatted text in which nothing is markup. */
static void put_formatted(weft_page *page, const char *format, va_list arguments)
{
    char text[WEFT_MESSAGE_SIZE];
    vsnprintf(text, sizeof text, format, arguments);
    weft_page_text(page, text);
}

void weft_page_tile(weft_page *page, const char *label, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("<div><b>", page->html);
    put_formatted(page, format, arguments);
    fputs("</b>", page->html);
    weft_page_text(page, label);
    fputs("</div>\n", page->html);
    va_end(arguments);
}

void weft_page_columns(weft_page *page, const char *headings)
{
    fputs("<tr>", page->html);
    for (const char *heading = headings; heading;) {
        size_t length = strcspn(heading, "|");
        bool is_words = *heading == ':';
        char text[WEFT_MESSAGE_SIZE];
        snprintf(text, sizeof text, "%.*s", (int)length - is_words, heading + is_words);
        fputs(is_words ? "<th scope=\"col\" class=\"text\">" : "<th scope=\"col\">", page->html);
        weft_page_text(page, text);
        fputs("</th>", page->html);
        heading = heading[length] ? heading + length + 1 : NULL;
    }
    fputs("</tr>\n", page->html);
}

void weft_page_fact(weft_page *page, const char *name, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("<tr><td>", page->html);
    weft_page_text(page, name);
    fputs("</td><td class=\"fact\">", page->html);
    put_formatted(page, format, arguments);
    fputs("</td></tr>\n", page->html);
    va_end(arguments);
}

weft_code weft_page_finish(weft_page *page, weft_error *error)
{
    fprintf(page->html, "<script>\n%s</script>\n</html>\n", weft_page_page_js);
    weft_code code = WEFT_OK;
    char *path = NULL;
    if (fflush(page->html) != 0 || ferror(page->html) || asprintf(&path, "%s/index.html", page->folder) < 0)
        code = weft_fail_memory(error, "page", page->size);
    else
        code = weft_write_file(path, page->bytes, page->size, error);
    free(path);
    weft_page_abandon(page);
    return code;
}

void weft_page_abandon(weft_page *page)
{
    if (page->html)
        fclose(page->html);
    free(page->bytes);
    free(page->folder);
    *page = (weft_page){0};
}
