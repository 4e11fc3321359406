#include "base/text/html_page.h"

#include "base/atomic_file.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static const char *const style =
    "\n"
    "body{font:16px/1.5 system-ui,sans-serif;max-width:1180px;margin:2em auto;padding:0 1em;color:#1c1c1c;"
    "background:#fcfcfb}\n"
    "h1{font-size:1.6em}h2{font-size:1.2em;margin-top:2em;border-bottom:1px solid #ccc}\n"
    "h3{font-size:1em;margin:1.4em 0 .3em}p.note{color:#555;font-size:.92em}\n"
    "table{border-collapse:collapse;margin:.6em 0}\n"
    "td,th{padding:.2em .9em .2em 0;text-align:right;vertical-align:top;font-variant-numeric:tabular-nums}\n"
    "td:first-child,th:first-child,.text{text-align:left}th{font-weight:600;border-bottom:1px solid #ccc}\n"
    "table.long{width:100%;font-size:.8em}table.long th{position:sticky;top:0;background:#fcfcfb}\n"
    "tr.bad td{background:#fdecea}tr.weak td{background:#fff6df}\n"
    ".tiles{display:grid;grid-template-columns:repeat(auto-fill,minmax(165px,1fr));gap:12px}\n"
    ".tiles div{border:1px solid #ccc;border-radius:6px;padding:.5em .9em;background:#fff;font-size:.85em;color:#555}\n"
    ".tiles b{display:block;font-size:1.7em;color:#1c1c1c}\n"
    ".row{display:flex;flex-wrap:wrap;gap:12px}figure{margin:0}\n"
    "figcaption{font-size:.85em;color:#555;max-width:262px}\n"
    "img{display:block;image-rendering:pixelated;background:#ddd;max-width:100%}\n"
    ".gallery{display:grid;grid-template-columns:repeat(auto-fill,minmax(360px,1fr));gap:14px}\n"
    ".gallery figure{background:#fff;border:1px solid #ccc;border-radius:6px;padding:10px}\n"
    ".gallery figure.bad{border-color:#d9483b}.gallery figcaption{max-width:none;margin-top:6px}\n"
    ".gallery div{display:grid;grid-template-columns:repeat(3,1fr);gap:6px}\n"
    ".gallery img{width:100%;aspect-ratio:1;object-fit:contain;background:#20242a;image-rendering:auto}\n"
    ".gallery img.texels{image-rendering:pixelated}\n"
    "svg.chart{width:100%;background:#fff;border:1px solid #ccc;border-radius:6px}\n";

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

void weft_page_fact(weft_page *page, const char *name, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("<tr><td>", page->html);
    weft_page_text(page, name);
    fputs("</td><td>", page->html);
    put_formatted(page, format, arguments);
    fputs("</td></tr>\n", page->html);
    va_end(arguments);
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
