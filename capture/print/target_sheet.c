#include "capture/print/sheets.h"

#include "capture/print/page.h"

#include <math.h>
#include <stdio.h>

const double weft_target_default_opening_mm = 50, weft_target_smallest_opening_mm = 20;

static const double hairline = 0.15, cut_line = 0.2;

/* A ring round the target, and how far cross hairs reach beyond a ball, mm or 32nds of the opening. */
static const double ring_units = 53.5, hair_mm = 3, pin_ring_mm = 3;

static const double ruler_length[] = {100, 50};

typedef struct sheet {
    const weft_target_sheet_settings *settings;
    weft_target target;
    double unit, scale; /* mm in a 32nd of the opening; of what is written, 1 for the default opening */
    weft_ruler ruler[2];
} sheet;

/* ---- What fits ---- */

double weft_target_largest_opening(const weft_paper *paper)
{
    weft_target unit = weft_target_printed(1);
    weft_rectangle r = weft_target_sheet(&unit);
    double across = weft_paper_printable_width(paper) / (r.x1 - r.x0);
    double along = weft_paper_printable_height(paper) / (r.y1 - r.y0);
    return floor(10 * fmin(across, along)) / 10;
}

/* The ball must stand on the paper, clear of the target's ring and its hairs within what can be printed on. */
static double largest_ball(const sheet *s)
{
    double place[2], reach = INFINITY;
    weft_target_ball(&s->target, 1, place);
    reach = fmin(reach, weft_paper_printable_width(&s->settings->paper) / 2 - fabs(place[0]));
    reach = fmin(reach, weft_paper_printable_height(&s->settings->paper) / 2 - fabs(place[1]));
    reach = fmin(reach, hypot(place[0], place[1]) - ring_units * s->unit - hair_mm);
    return 2 * reach;
}

static weft_rectangle outline_of_ball(const sheet *s, int index)
{
    double place[2], reach = s->settings->ball_mm / 2 + hair_mm;
    weft_target_ball(&s->target, index, place);
    return (weft_rectangle){place[0] - reach, place[1] - reach, place[0] + reach, place[1] + reach};
}

static bool overlap(weft_rectangle a, weft_rectangle b)
{
    return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

/* With the paper round it that its finder needs. */
static weft_rectangle outline_of_marker(const sheet *s, int id)
{
    weft_rectangle r = weft_target_marker(&s->target, id);
    double cell = (r.x1 - r.x0) / 6;
    return (weft_rectangle){r.x0 - cell, r.y0 - cell, r.x1 + cell, r.y1 + cell};
}

static bool is_clear(const sheet *s, const weft_ruler *ruler)
{
    weft_rectangle r = weft_ruler_outline(ruler);
    double width = weft_paper_printable_width(&s->settings->paper);
    double height = weft_paper_printable_height(&s->settings->paper), ring = ring_units * s->unit;
    for (int ball = 0; s->settings->ball_mm > 0 && ball < WEFT_TARGET_BALL_COUNT; ball++) {
        if (overlap(r, outline_of_ball(s, ball)))
            return false;
    }
    for (int id = 0; id < WEFT_SHEET_MARKER_COUNT; id++) {
        if (overlap(r, outline_of_marker(s, id)))
            return false;
    }
    /* The nearest point to the middle of the ring. */
    double x = fmax(0, fmax(r.x0, -r.x1)), y = fmax(0, fmax(r.y0, -r.y1));
    return r.x0 >= -width / 2 && r.x1 <= width / 2 && r.y0 >= -height / 2 && r.y1 <= height / 2 && hypot(x, y) > ring;
}

/* Moves a bar along itself, from the middle of the page outwards, to the first place that is clear. */
static bool slide(const sheet *s, weft_ruler *ruler)
{
    const double step_mm = 1;
    double *along = ruler->upright ? &ruler->y : &ruler->x;
    double reach = (ruler->upright ? weft_paper_printable_height(&s->settings->paper)
                                   : weft_paper_printable_width(&s->settings->paper)) /
                   2;
    for (int step = 0; step * step_mm <= reach; step++) {
        for (int side = 1; side >= -1; side -= 2) {
            *along = side * step * step_mm;
            if (is_clear(s, ruler))
                return true;
        }
    }
    return false;
}

/* One along the left edge of the sheet, on it or beside it, and one below it, as far as the page reaches. */
static bool place_rulers(sheet *s)
{
    weft_rectangle r = weft_target_sheet(&s->target);
    const weft_paper *paper = &s->settings->paper;
    double ball[2], below = 6 * s->scale, left = -weft_paper_printable_width(paper) / 2 + 0.5;
    double bottom = -weft_paper_printable_height(paper) / 2 + 0.5, beside = 9 * s->scale;
    weft_target_ball(&s->target, 1, ball);
    double lowest = fmin(r.y0 - below, ball[1] - s->settings->ball_mm / 2 - hair_mm - 8 * s->scale);
    for (size_t i = 0; i < sizeof ruler_length / sizeof ruler_length[0]; i++) {
        double length = ruler_length[i];
        s->ruler[0] = (weft_ruler){0, fmax(lowest, bottom), false, length, s->scale};
        s->ruler[1] = (weft_ruler){fmax(r.x0, left), 0, true, length, s->scale};
        bool is_beside = slide(s, &s->ruler[1]);
        if (!is_beside) {
            s->ruler[1].x = fmax(r.x0 - beside, left);
            is_beside = slide(s, &s->ruler[1]);
        }
        if (is_beside && slide(s, &s->ruler[0]) &&
            !overlap(weft_ruler_outline(&s->ruler[0]), weft_ruler_outline(&s->ruler[1])))
            return true;
    }
    return false;
}

static sheet sheet_of(const weft_target_sheet_settings *settings)
{
    weft_target target = weft_target_printed(settings->opening_mm);
    double scale = settings->opening_mm / weft_target_default_opening_mm;
    return (sheet){
        .settings = settings, .target = target, .unit = settings->opening_mm / 32, .scale = fmin(scale, 1.2)};
}

static weft_code check_opening(weft_target_sheet_settings *settings, weft_error *error)
{
    double largest = weft_target_largest_opening(&settings->paper);
    if (largest < weft_target_smallest_opening_mm)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "--paper %s is too small: the largest opening that fits is %g mm, the smallest of use %g mm",
                         settings->paper.name, fmax(largest, 0), weft_target_smallest_opening_mm);
    if (settings->opening_mm == 0)
        settings->opening_mm = fmin(weft_target_default_opening_mm, largest);
    if (settings->opening_mm > largest)
        return weft_fail(error, WEFT_BAD_USAGE, "--opening %g does not fit %s: the largest that fits is %g",
                         settings->opening_mm, settings->paper.name, largest);
    return WEFT_OK;
}

weft_code weft_target_sheet_check(weft_target_sheet_settings *settings, weft_error *error)
{
    WEFT_TRY(check_opening(settings, error));
    sheet s = sheet_of(settings);
    double ball = floor(10 * largest_ball(&s)) / 10;
    if (settings->ball_mm > ball)
        return weft_fail(error, WEFT_BAD_USAGE, "--balls %g does not fit an opening of %g mm on %s: the largest is %g",
                         settings->ball_mm, settings->opening_mm, settings->paper.name, ball);
    if (!place_rulers(&s))
        return weft_fail(error, WEFT_BAD_USAGE,
                         "an opening of %g mm and balls of %g mm leave no room for the check bars on %s",
                         settings->opening_mm, settings->ball_mm, settings->paper.name);
    return WEFT_OK;
}

/* ---- The drawing that registration compares with ---- */

enum { MARKER_CELLS = 6 };

static bool is_ink(const weft_target *target, weft_rectangle outline, int column, int row)
{
    double x = outline.x0 + (column + 0.5) / MARKER_CELLS * (outline.x1 - outline.x0);
    double y = outline.y0 + (row + 0.5) / MARKER_CELLS * (outline.y1 - outline.y0);
    return weft_target_sheet_reflectance(target, x, y) < (target->ink_reflectance + target->paper_reflectance) / 2;
}

static double between(double from, double to, int cell)
{
    return from + (to - from) * cell / MARKER_CELLS;
}

static void draw_row_of_cells(weft_print_page *page, const weft_target *target, weft_rectangle outline, int row)
{
    int end;
    for (int column = 0; column < MARKER_CELLS; column = end + 1) {
        for (end = column; end < MARKER_CELLS && is_ink(target, outline, end, row);)
            end++;
        if (end > column)
            weft_print_add_rectangle(
                page, (weft_rectangle){between(outline.x0, outline.x1, column), between(outline.y0, outline.y1, row),
                                       between(outline.x0, outline.x1, end), between(outline.y0, outline.y1, row + 1)});
    }
}

static void draw_markers(weft_print_page *page, const weft_target *target)
{
    for (int id = 0; id < WEFT_SHEET_MARKER_COUNT; id++) {
        weft_rectangle outline = weft_target_marker(target, id);
        for (int row = 0; row < MARKER_CELLS; row++)
            draw_row_of_cells(page, target, outline, row);
    }
    weft_print_fill(page);
}

/* ---- The opening, the balls and the pin ---- */

/* A line whose outer edge is that of the opening: it lies where the sample will. */
static void draw_opening(const sheet *s, weft_print_page *page)
{
    double half = s->target.opening_mm / 2, inner = half - cut_line, size = 2.9 * s->scale;
    weft_print_add_rectangle(page, (weft_rectangle){-half, inner, half, half});
    weft_print_add_rectangle(page, (weft_rectangle){-half, -half, half, -inner});
    weft_print_add_rectangle(page, (weft_rectangle){-half, -inner, -inner, inner});
    weft_print_add_rectangle(page, (weft_rectangle){inner, -inner, half, inner});
    weft_print_fill(page);
    weft_print_text(page, 0, 1.9 * size, 1.35 * size, WEFT_PRINT_CENTRED, 0, "Cut out this square");
    weft_print_text(page, 0, 0.3 * size, size, WEFT_PRINT_CENTRED, 0, "along the outer edge of its line.");
    weft_print_text(page, 0, -1.9 * size, size, WEFT_PRINT_CENTRED, 0, "The sample goes under the sheet");
    weft_print_text(page, 0, -3.2 * size, size, WEFT_PRINT_CENTRED, 0, "and shows here.");
}

static void draw_cross(weft_print_page *page, double x, double y, double reach)
{
    weft_print_line(page, x - reach, y, x + reach, y, hairline);
    weft_print_line(page, x, y - reach, x, y + reach, hairline);
}

/* The ring is what a ball covers for an eye above it. */
static void draw_ball(const sheet *s, weft_print_page *page, int index)
{
    char text[48];
    double place[2], radius = s->settings->ball_mm / 2, size = 2.9 * s->scale;
    weft_target_ball(&s->target, index, place);
    weft_print_circle(page, place[0], place[1], radius, hairline);
    weft_print_circle(page, place[0], place[1], fmin(1.5, radius / 3), hairline);
    draw_cross(page, place[0], place[1], radius + hair_mm);
    double side = place[1] > 0 ? -1 : 1; /* toward the middle of the sheet */
    double y = place[1] + side * (radius + hair_mm + size) - (side > 0 ? 0.7 * size : 0);
    snprintf(text, sizeof text, "mirror ball, %g mm", s->settings->ball_mm);
    weft_print_text(page, place[0], y, size, WEFT_PRINT_CENTRED, 0, text);
}

static void draw_pin(const sheet *s, weft_print_page *page)
{
    char text[48];
    double place[2], size = 2.9 * s->scale;
    weft_target_pin(&s->target, place);
    weft_print_disc(page, place[0], place[1], 0.5);
    weft_print_circle(page, place[0], place[1], pin_ring_mm, hairline);
    draw_cross(page, place[0], place[1], pin_ring_mm + hair_mm);
    snprintf(text, sizeof text, "pin, %g mm high", s->settings->pin_mm);
    weft_print_text(page, place[0], place[1] - pin_ring_mm - hair_mm - size, size, WEFT_PRINT_CENTRED, 0, text);
}

/* ---- Words ---- */

static void draw_title(const sheet *s, weft_print_page *page)
{
    char text[128];
    double size = 6.5 * s->scale, top = weft_paper_printable_height(&s->settings->paper) / 2;
    double y = fmin(top - size, 84 * s->unit + size);
    weft_print_text(page, 0, y, size, WEFT_PRINT_CENTRED, 0, "Weft target");
    const weft_target_sheet_settings *settings = s->settings;
    int length = snprintf(text, sizeof text, "opening %.4g mm", settings->opening_mm);
    if (settings->ball_mm > 0)
        length += snprintf(text + length, sizeof text - (size_t)length, "  \u00b7  balls %g mm", settings->ball_mm);
    if (settings->pin_mm > 0)
        length += snprintf(text + length, sizeof text - (size_t)length, "  \u00b7  pin %g mm", settings->pin_mm);
    snprintf(text + length, sizeof text - (size_t)length, "  \u00b7  paper %s", settings->paper.name);
    weft_print_text(page, 0, y - 5.5 * s->scale, 3.1 * s->scale, WEFT_PRINT_CENTRED, 0, text);
    /* Beside the marker in the middle. */
    double x = -16 * s->unit, arrow = 68 * s->unit, wide = 3.2 * s->scale, high = 5.5 * s->scale;
    weft_print_triangle(page, (const double[3][2]){{x - wide, arrow}, {x + wide, arrow}, {x, arrow + high}});
    weft_print_text(page, x, arrow - 4 * s->scale, 3.6 * s->scale, WEFT_PRINT_CENTRED, 0, "up");
}

static void draw_lines(const sheet *s, weft_print_page *page, double x, const char *const *line)
{
    double size = 3 * s->scale, y = -57 * s->unit;
    for (int i = 0; line[i]; i++, y -= 1.42 * size)
        weft_print_text(page, x, y, size, WEFT_PRINT_LEFT, 0, line[i]);
}

static void draw_words(const sheet *s, weft_print_page *page)
{
    char measure[96], again[96], balls[96] = "", pin[96] = "";
    double length = s->ruler[0].length_mm, ball_mm = s->settings->ball_mm, pin_mm = s->settings->pin_mm;
    snprintf(measure, sizeof measure, "2   Measure both bars with a ruler. If they are not %g mm, print", length);
    snprintf(again, sizeof again, "     again, or tell Weft: --opening %.4g \u00d7 measured / %g.",
             s->settings->opening_mm, length);
    if (ball_mm > 0)
        snprintf(balls, sizeof balls, "5   Stand a mirror ball of %g mm in each circle%s", ball_mm,
                 pin_mm > 0 ? "," : ".");
    if (pin_mm > 0)
        snprintf(pin, sizeof pin, "%s %g mm high, upright on its dot.",
                 ball_mm > 0 ? "     and a pin," : "5   Stand a pin,", pin_mm);
    if (ball_mm <= 0 && pin_mm <= 0)
        snprintf(balls, sizeof balls, "5   Tell weft photographs: --balls 0 --pin 0.");
    draw_lines(s, page, -56 * s->unit,
               (const char *const[]){"1   Print on matt, plain, white paper, at 100 %: no \u201cfit to page\u201d.",
                                     measure, again, "3   Cut out the square.", NULL});
    draw_lines(s, page, 3 * s->unit,
               (const char *const[]){"4   Lay the sheet flat on the sample. Keep the inside",
                                     "     of the ring free: write nothing there.", balls, pin, NULL});
}

static void draw_sheet(const sheet *s, weft_print_page *page)
{
    draw_markers(page, &s->target);
    draw_opening(s, page);
    for (int ball = 0; s->settings->ball_mm > 0 && ball < WEFT_TARGET_BALL_COUNT; ball++)
        draw_ball(s, page, ball);
    if (s->settings->pin_mm > 0)
        draw_pin(s, page);
    for (int i = 0; i < 2; i++)
        weft_ruler_draw(&s->ruler[i], page);
    draw_title(s, page);
    draw_words(s, page);
    weft_print_grey(page, 0.5);
    weft_print_circle(page, 0, 0, ring_units * s->unit, hairline);
}

weft_code weft_target_sheet_print(const weft_target_sheet_settings *settings, const char *path, weft_error *error)
{
    weft_print_page *page;
    sheet s = sheet_of(settings);
    place_rulers(&s);
    WEFT_TRY(weft_print_page_begin(path, &settings->paper, "Weft target", &page, error));
    draw_sheet(&s, page);
    return weft_print_page_finish(page, error);
}
