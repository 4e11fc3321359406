#include "base/page.h"

#include "base/atomic_file.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static const char *const style =
    "body{font:16px/1.5 system-ui,sans-serif;max-width:1180px;margin:2em auto;padding:0 "
    "1em;color:#1c1c1c;background:#fcfcfb}"
    "h1{font-size:1.6em}h2{font-size:1.2em;margin-top:2em;border-bottom:1px solid #ccc}"
    "h3{font-size:1em;margin:1.4em 0 .3em}"
    "table{border-collapse:collapse;margin:.6em 0}td,th{padding:.2em .9em .2em 0;text-align:right;vertical-align:top;"
    "font-variant-numeric:tabular-nums}td:first-child,th:first-child{text-align:left}th{font-weight:600;border-bottom:"
    "1px solid #ccc}"
    ".tiles{display:flex;flex-wrap:wrap;gap:12px}.tiles div{border:1px solid #ccc;border-radius:6px;padding:.5em "
    ".9em;background:#fff;"
    "font-size:.85em;color:#555}.tiles b{display:block;font-size:1.7em;color:#1c1c1c}"
    ".row{display:flex;flex-wrap:wrap;gap:12px}figure{margin:0}figcaption{font-size:.85em;color:#555;max-width:262px}"
    "img{display:block;image-rendering:pixelated;background:#ddd;max-width:100%}p.note{color:#555;font-size:.92em}";

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
    fprintf(page->html, "</title>\n<style>%s</style>\n<h1>", style);
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

void weft_page_fact(weft_page *page, const char *name, const char *format, ...)
{
    char value[WEFT_MESSAGE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(value, sizeof value, format, arguments);
    va_end(arguments);
    fputs("<tr><td>", page->html);
    weft_page_text(page, name);
    fputs("</td><td>", page->html);
    weft_page_text(page, value);
    fputs("</td></tr>\n", page->html);
}

weft_code weft_page_finish(weft_page *page, weft_error *error)
{
    fputs("</html>\n", page->html);
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
