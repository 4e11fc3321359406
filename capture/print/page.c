#include "capture/print/page.h"

#include "base/atomic_file.h"
#include "base/picture/font_file.h"

#include <cairo-ft.h>
#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>

const double weft_paper_margin_mm = 5;

static const double smallest_side_mm = 40, largest_side_mm = 2000;

static const weft_paper known_paper[] = {{"A4", 210, 297},         {"A3", 297, 420},        {"A5", 148, 210},
                                         {"letter", 215.9, 279.4}, {"legal", 215.9, 355.6}, {"tabloid", 279.4, 431.8}};

static bool is_side(double side_mm)
{
    return side_mm >= smallest_side_mm && side_mm <= largest_side_mm;
}

/* "WxH" and nothing else. */
static bool parse_sides(const char *text, weft_paper *paper)
{
    char *end;
    paper->width_mm = strtod(text, &end);
    if (end == text || *end != 'x')
        return false;
    const char *height = end + 1;
    paper->height_mm = strtod(height, &end);
    if (end == height || *end || !is_side(paper->width_mm) || !is_side(paper->height_mm))
        return false;
    snprintf(paper->name, sizeof paper->name, "%g x %g mm", paper->width_mm, paper->height_mm);
    return true;
}

weft_code weft_paper_parse(const char *text, weft_paper *paper, weft_error *error)
{
    for (size_t i = 0; i < sizeof known_paper / sizeof known_paper[0]; i++) {
        if (strcasecmp(text, known_paper[i].name) == 0) {
            *paper = known_paper[i];
            return WEFT_OK;
        }
    }
    if (parse_sides(text, paper))
        return WEFT_OK;
    return weft_fail(error, WEFT_BAD_USAGE,
                     "--paper needs A4, A3, A5, letter, legal, tabloid or WxH with sides from %g to %g mm, not '%s'",
                     smallest_side_mm, largest_side_mm, text);
}

double weft_paper_printable_width(const weft_paper *paper)
{
    return paper->width_mm - 2 * weft_paper_margin_mm;
}

double weft_paper_printable_height(const weft_paper *paper)
{
    return paper->height_mm - 2 * weft_paper_margin_mm;
}

static const double points_per_mm = 72 / 25.4;

struct weft_print_page {
    char *path;
    char *bytes; /* as `stream` has them */
    size_t size;
    FILE *stream;
    cairo_t *cairo;
};

/* ---- The file ---- */

static bool has_extension(const char *path, const char *extension)
{
    size_t length = strlen(path), tail = strlen(extension);
    return length > tail && strcasecmp(path + length - tail, extension) == 0;
}

weft_code weft_print_page_check_name(const char *path, weft_error *error)
{
    if (has_extension(path, ".pdf") || has_extension(path, ".svg"))
        return WEFT_OK;
    return weft_fail(error, WEFT_BAD_USAGE, "'%s' does not end in .pdf or .svg", path);
}

static cairo_status_t append(void *stream, const unsigned char *bytes, unsigned int size)
{
    return fwrite(bytes, 1, size, stream) == size ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

/* https://reproducible-builds.org/specs/source-date-epoch */
static void format_date(char text[32])
{
    const char *given = getenv("SOURCE_DATE_EPOCH");
    time_t seconds = given ? (time_t)strtoll(given, NULL, 10) : 0;
    struct tm date;
    if (!gmtime_r(&seconds, &date) || !strftime(text, 32, "%Y-%m-%dT%H:%M:%SZ", &date))
        snprintf(text, 32, "1970-01-01T00:00:00Z");
}

static cairo_surface_t *create_pdf(FILE *stream, double width, double height, const char *title)
{
    char date[32];
    format_date(date);
    cairo_surface_t *surface = cairo_pdf_surface_create_for_stream(append, stream, width, height);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, title);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATOR, "weft " WEFT_VERSION);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, date);
    return surface;
}

static cairo_surface_t *create_svg(FILE *stream, double width, double height)
{
    cairo_surface_t *surface = cairo_svg_surface_create_for_stream(append, stream, width, height);
    cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PT);
    return surface;
}

/* ---- The typeface ---- */

typedef struct typeface {
    FT_Library library;
    FT_Face face;
} typeface;

static void free_typeface(void *data)
{
    typeface *opened = data;
    FT_Done_Face(opened->face);
    FT_Done_FreeType(opened->library);
    free(opened);
}

static typeface *open_typeface(void)
{
    typeface *opened = calloc(1, sizeof *opened);
    if (opened && FT_Init_FreeType(&opened->library) == 0) {
        if (FT_New_Memory_Face(opened->library, weft_font_file, (FT_Long)weft_font_file_size, 0, &opened->face) == 0)
            return opened;
        FT_Done_FreeType(opened->library);
    }
    free(opened);
    return NULL;
}

/* Cairo keeps a typeface for longer than a page lives: it frees it when it lets it go. */
static cairo_status_t set_typeface(cairo_t *cairo)
{
    static const cairo_user_data_key_t key;
    typeface *opened = open_typeface();
    if (!opened)
        return CAIRO_STATUS_NO_MEMORY;
    cairo_font_face_t *face = cairo_ft_font_face_create_for_ft_face(opened->face, FT_LOAD_NO_HINTING);
    cairo_status_t status = cairo_font_face_set_user_data(face, &key, opened, free_typeface);
    if (status == CAIRO_STATUS_SUCCESS)
        cairo_set_font_face(cairo, face);
    else
        free_typeface(opened);
    cairo_font_face_destroy(face);
    return status;
}

/* ---- Begin and finish ---- */

void weft_print_page_abandon(weft_print_page *page)
{
    cairo_destroy(page->cairo);
    if (page->stream)
        fclose(page->stream);
    free(page->bytes);
    free(page->path);
    free(page);
}

static weft_code fail_with(cairo_status_t status, const char *path, weft_error *error)
{
    if (status == CAIRO_STATUS_NO_MEMORY || status == CAIRO_STATUS_WRITE_ERROR) /* it writes to memory */
        return weft_fail_memory(error, path, 0);
    return weft_fail(error, WEFT_SYSTEM, "cannot draw '%s': %s", path, cairo_status_to_string(status));
}

/* Millimetres from the middle, y up. */
static weft_code begin_drawing(weft_print_page *page, const weft_paper *paper, const char *title, weft_error *error)
{
    double width = paper->width_mm * points_per_mm, height = paper->height_mm * points_per_mm;
    cairo_surface_t *surface = has_extension(page->path, ".pdf") ? create_pdf(page->stream, width, height, title)
                                                                 : create_svg(page->stream, width, height);
    page->cairo = cairo_create(surface);
    cairo_surface_destroy(surface);
    cairo_translate(page->cairo, width / 2, height / 2);
    cairo_scale(page->cairo, points_per_mm, -points_per_mm);
    weft_print_grey(page, 0);
    cairo_status_t status = set_typeface(page->cairo);
    return status == CAIRO_STATUS_SUCCESS ? WEFT_OK : fail_with(status, page->path, error);
}

weft_code weft_print_page_begin(const char *path, const weft_paper *paper, const char *title, weft_print_page **page,
                                weft_error *error)
{
    WEFT_TRY(weft_print_page_check_name(path, error));
    weft_print_page *begun = calloc(1, sizeof *begun);
    if (!begun)
        return weft_fail_memory(error, path, sizeof *begun);
    begun->path = strdup(path);
    begun->stream = open_memstream(&begun->bytes, &begun->size);
    weft_code code =
        begun->path && begun->stream ? begin_drawing(begun, paper, title, error) : weft_fail_memory(error, path, 0);
    if (code != WEFT_OK) {
        weft_print_page_abandon(begun);
        return code;
    }
    *page = begun;
    return WEFT_OK;
}

static weft_code write_page(weft_print_page *page, weft_error *error)
{
    cairo_surface_t *surface = cairo_get_target(page->cairo);
    cairo_show_page(page->cairo);
    cairo_status_t status = cairo_status(page->cairo);
    cairo_surface_finish(surface);
    if (status == CAIRO_STATUS_SUCCESS)
        status = cairo_surface_status(surface);
    if (status != CAIRO_STATUS_SUCCESS)
        return fail_with(status, page->path, error);
    if (fflush(page->stream) != 0)
        return weft_fail_memory(error, page->path, page->size);
    return weft_write_file(page->path, page->bytes, page->size, error);
}

weft_code weft_print_page_finish(weft_print_page *page, weft_error *error)
{
    weft_code code = write_page(page, error);
    weft_print_page_abandon(page);
    return code;
}

/* ---- Drawing ---- */

void weft_print_grey(weft_print_page *page, double level)
{
    cairo_set_source_rgb(page->cairo, level, level, level);
}

void weft_print_add_rectangle(weft_print_page *page, weft_rectangle r)
{
    cairo_rectangle(page->cairo, r.x0, r.y0, r.x1 - r.x0, r.y1 - r.y0);
}

void weft_print_fill(weft_print_page *page)
{
    cairo_fill(page->cairo);
}

static void stroke(weft_print_page *page, double width_mm)
{
    cairo_set_line_width(page->cairo, width_mm);
    cairo_stroke(page->cairo);
}

void weft_print_line(weft_print_page *page, double x0, double y0, double x1, double y1, double width_mm)
{
    cairo_move_to(page->cairo, x0, y0);
    cairo_line_to(page->cairo, x1, y1);
    stroke(page, width_mm);
}

static void trace_circle(weft_print_page *page, double x, double y, double radius_mm)
{
    cairo_new_sub_path(page->cairo);
    cairo_arc(page->cairo, x, y, radius_mm, 0, 2 * M_PI);
    cairo_close_path(page->cairo);
}

void weft_print_circle(weft_print_page *page, double x, double y, double radius_mm, double width_mm)
{
    trace_circle(page, x, y, radius_mm);
    stroke(page, width_mm);
}

void weft_print_disc(weft_print_page *page, double x, double y, double radius_mm)
{
    trace_circle(page, x, y, radius_mm);
    cairo_fill(page->cairo);
}

void weft_print_triangle(weft_print_page *page, const double corner[3][2])
{
    for (int i = 0; i < 3; i++)
        cairo_line_to(page->cairo, corner[i][0], corner[i][1]);
    cairo_close_path(page->cairo);
    cairo_fill(page->cairo);
}

double weft_print_text(weft_print_page *page, double x, double y, double size_mm, weft_print_align align,
                       int quarter_turns, const char *text)
{
    cairo_text_extents_t extents;
    cairo_save(page->cairo);
    cairo_translate(page->cairo, x, y);
    cairo_rotate(page->cairo, quarter_turns * M_PI / 2);
    cairo_scale(page->cairo, 1, -1);
    cairo_set_font_size(page->cairo, size_mm);
    cairo_text_extents(page->cairo, text, &extents);
    double width = extents.x_advance;
    cairo_move_to(page->cairo, align == WEFT_PRINT_LEFT ? 0 : align == WEFT_PRINT_CENTRED ? -width / 2 : -width, 0);
    cairo_show_text(page->cairo, text);
    cairo_new_path(page->cairo); /* of the point behind the text */
    cairo_restore(page->cairo);
    return width;
}
