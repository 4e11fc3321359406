#include "capture/print/page.h"

#include <math.h>
#include <stdio.h>

static const double line_width = 0.15, number_size = 2.3;

/* The highest tick, and how far numbers reach beyond it and beyond both ends, at scale 1. */
static const double tick_height = 3.6, number_height = 2.6, overhang = 5;

weft_rectangle weft_ruler_outline(const weft_ruler *r)
{
    double along = r->length_mm / 2 + overhang * r->scale, across = (tick_height + number_height) * r->scale;
    if (r->upright)
        return (weft_rectangle){r->x - line_width / 2, r->y - along, r->x + across, r->y + along};
    return (weft_rectangle){r->x - along, r->y - line_width / 2, r->x + along, r->y + across};
}

static double height_of_tick(const weft_ruler *r, int mm)
{
    double height = mm % 10 == 0 ? tick_height : mm % 5 == 0 ? 0.75 * tick_height : 0.5 * tick_height;
    return height * r->scale;
}

static void draw_tick(const weft_ruler *r, weft_print_page *page, int mm)
{
    double along = mm - r->length_mm / 2, height = height_of_tick(r, mm);
    if (r->upright)
        weft_print_line(page, r->x, r->y + along, r->x + height, r->y + along, line_width);
    else
        weft_print_line(page, r->x + along, r->y, r->x + along, r->y + height, line_width);
}

static void draw_number(const weft_ruler *r, weft_print_page *page, int mm)
{
    char text[16];
    double along = mm - r->length_mm / 2, height = (tick_height + 0.7) * r->scale, size = number_size * r->scale;
    snprintf(text, sizeof text, mm < r->length_mm ? "%d" : "%d mm", mm);
    if (r->upright)
        weft_print_text(page, r->x + height, r->y + along, size, WEFT_PRINT_CENTRED, 3, text);
    else
        weft_print_text(page, r->x + along, r->y + height, size, WEFT_PRINT_CENTRED, 0, text);
}

void weft_ruler_draw(const weft_ruler *r, weft_print_page *page)
{
    double half = r->length_mm / 2 + line_width / 2;
    if (r->upright)
        weft_print_line(page, r->x, r->y - half, r->x, r->y + half, line_width);
    else
        weft_print_line(page, r->x - half, r->y, r->x + half, r->y, line_width);
    for (int mm = 0; mm <= r->length_mm; mm++)
        draw_tick(r, page, mm);
    for (int mm = 0; mm <= r->length_mm; mm += 10)
        draw_number(r, page, mm);
}
