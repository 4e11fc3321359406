#include "compare/tradeoff/plot.h"

#include "compare/tradeoff/label_place.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    WIDTH = 760,
    HEIGHT = 430,
    LEFT = 62,
    RIGHT = 18,
    TOP = 34,
    BOTTOM = 48,
    RADIUS = 9,
    MARK_RADIUS = RADIUS + 4,
    THUMBNAIL = 96,
    MOST_MARKED = 16,
    MOST_DISCS = 64
};

/* ---- Axes ---- */

/* From `low` to `high`, both above 0, over so many pixels. */
typedef struct log_axis {
    double low, high;
    double start, length;
} log_axis;

static double place_on(const log_axis *axis, double value)
{
    return axis->start + axis->length * log(value / axis->low) / log(axis->high / axis->low);
}

static bool is_shown(const weft_plot_point *point)
{
    return point->x > 0 && point->y > 0 && isfinite(point->x) && isfinite(point->y);
}

/* A little beyond the outermost points, and at least a factor of two. */
static log_axis fit_axis(const weft_plot *plot, bool vertical)
{
    log_axis axis = {INFINITY, 0, vertical ? HEIGHT - BOTTOM : LEFT,
                     vertical ? -(HEIGHT - TOP - BOTTOM) : WIDTH - LEFT - RIGHT};
    for (int i = 0; i < plot->point_count; i++) {
        double value = vertical ? plot->point[i].y : plot->point[i].x;
        if (!is_shown(&plot->point[i]))
            continue;
        axis.low = fmin(axis.low, value);
        axis.high = fmax(axis.high, value);
    }
    double margin = fmax(pow(axis.high / axis.low, 0.07), sqrt(2 * axis.low / axis.high));
    axis.low /= margin;
    axis.high *= margin;
    return axis;
}

/* So many times powers of ten are ticks. */
typedef struct tick_steps {
    int count;
    double step[7];
} tick_steps;

/* More over a short axis than over a long one. */
static tick_steps choose_steps(const log_axis *axis)
{
    double decades = log10(axis->high / axis->low);
    if (decades > 3.5)
        return (tick_steps){1, {1}};
    return decades > 1 ? (tick_steps){3, {1, 2, 5}} : (tick_steps){7, {1, 1.5, 2, 3, 4, 5, 7}};
}

static void print_tick(double value, char text[16])
{
    static const struct {
        double unit;
        const char *letter;
    } prefix[] = {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}};
    for (size_t i = 0; i < sizeof prefix / sizeof *prefix; i++) {
        if (value >= 0.999 * prefix[i].unit) {
            snprintf(text, 16, "%.3g%s", value / prefix[i].unit, prefix[i].letter);
            return;
        }
    }
    snprintf(text, 16, "%.3g", value);
}

static void draw_tick(weft_page *page, const log_axis *axis, bool vertical, double value)
{
    char text[16];
    double at = place_on(axis, value);
    print_tick(value, text);
    if (vertical)
        fprintf(page->html, "<path d=\"M%d %.1fH%d\"/><text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%s</text>", LEFT,
                at, WIDTH - RIGHT, LEFT - 7, at + 4, text);
    else
        fprintf(page->html, "<path d=\"M%.1f %dV%d\"/><text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%s</text>", at,
                TOP, HEIGHT - BOTTOM, at, HEIGHT - BOTTOM + 17, text);
}

static void draw_axis(weft_page *page, const log_axis *axis, bool vertical)
{
    tick_steps steps = choose_steps(axis);
    for (int power = (int)floor(log10(axis->low)); power <= (int)floor(log10(axis->high)); power++) {
        for (int i = 0; i < steps.count; i++) {
            double value = steps.step[i] * pow(10, power);
            if (value >= axis->low && value <= axis->high)
                draw_tick(page, axis, vertical, value);
        }
    }
}

static void draw_frame(weft_page *page, const weft_plot *plot, const log_axis *x, const log_axis *y)
{
    fputs("<g class=\"grid\">", page->html);
    draw_axis(page, x, false);
    draw_axis(page, y, true);
    fprintf(page->html, "</g>\n<text x=\"%d\" y=\"20\" class=\"title\">", LEFT);
    weft_page_text(page, plot->title);
    fprintf(page->html, "</text><text class=\"axis\" x=\"%d\" y=\"%d\" text-anchor=\"end\">", WIDTH - RIGHT,
            HEIGHT - 8);
    weft_page_text(page, plot->x_label);
    fprintf(page->html,
            "</text><text class=\"axis\" x=\"14\" y=\"%d\" text-anchor=\"end\" transform=\"rotate(-90 14 %d)\">", TOP,
            TOP);
    weft_page_text(page, plot->y_label);
    fputs("</text>\n", page->html);
}

/* ---- Points ---- */

static int compare_by_x(const void *left, const void *right)
{
    const weft_plot_point *const *a = left, *const *b = right;
    return ((*a)->x > (*b)->x) - ((*a)->x < (*b)->x);
}

/* A staircase: what is to be had for so much and no more. */
static weft_code draw_front(weft_page *page, const weft_plot *plot, const log_axis *x, const log_axis *y,
                            weft_error *error)
{
    const weft_plot_point **order = calloc((size_t)plot->point_count + 1, sizeof *order);
    size_t count = 0;
    if (!order)
        return weft_fail_memory(error, "plot", (size_t)plot->point_count * sizeof *order);
    for (int i = 0; i < plot->point_count; i++) {
        if (plot->point[i].is_joined && is_shown(&plot->point[i]))
            order[count++] = &plot->point[i];
    }
    qsort(order, count, sizeof *order, compare_by_x);
    for (size_t i = 0; i < count; i++)
        fprintf(page->html, i == 0 ? "<path class=\"front\" d=\"M%.1f %.1f" : "H%.1fV%.1f", place_on(x, order[i]->x),
                place_on(y, order[i]->y));
    fputs(count > 0 ? "\"/>\n" : "", page->html);
    free(order);
    return WEFT_OK;
}

/* What labels must not cover: the rings of marked points, and the labels that are there already. What they had better
 * not: the numbers of the axis at the left, and the other points, as far as there is room for them here. */
typedef struct taken_boxes {
    weft_label_box box[2 * MOST_MARKED], disc[MOST_DISCS];
    size_t count, disc_count;
} taken_boxes;

static weft_label_box box_around(double x, double y, double radius)
{
    return (weft_label_box){x - radius, y - radius, x + radius, y + radius};
}

static taken_boxes points_of(const weft_plot *plot, const log_axis *x, const log_axis *y)
{
    taken_boxes taken = {.disc = {{0, 0, LEFT, HEIGHT}}, .disc_count = 1};
    for (int i = 0; i < plot->point_count; i++) {
        const weft_plot_point *point = &plot->point[i];
        if (!is_shown(point))
            continue;
        double at_x = place_on(x, point->x), at_y = place_on(y, point->y);
        if (point->is_marked && taken.count < MOST_MARKED)
            taken.box[taken.count++] = box_around(at_x, at_y, MARK_RADIUS);
        else if (!point->is_marked && taken.disc_count < MOST_DISCS)
            taken.disc[taken.disc_count++] = box_around(at_x, at_y, RADIUS);
    }
    return taken;
}

static void draw_label(weft_page *page, const weft_plot_point *point, double x, double y, taken_boxes *taken)
{
    const weft_label_obstacles obstacles = {taken->box, taken->disc, taken->count, taken->disc_count};
    weft_label_place place =
        weft_label_place_choose(x, y, RADIUS, strlen(point->label), WIDTH, HEIGHT - BOTTOM, &obstacles);
    if (taken->count < sizeof taken->box / sizeof *taken->box)
        taken->box[taken->count++] = place.box;
    fprintf(page->html, "<text class=\"label\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", place.x, place.y,
            place.ends_there ? "end" : "start");
    weft_page_text(page, point->label);
    fputs("</text>", page->html);
}

/* Beside the point, where there is room. */
static void draw_thumbnail(weft_page *page, const weft_plot_point *point, double x, double y)
{
    double left = x > WIDTH / 2.0 ? x - THUMBNAIL - 2 * RADIUS : x + 2 * RADIUS;
    double top = fmin(fmax(y - THUMBNAIL - RADIUS, 4), HEIGHT - THUMBNAIL - 4);
    fprintf(page->html, "<g class=\"shown\"><rect x=\"%.1f\" y=\"%.1f\" width=\"%d\" height=\"%d\"/>", left - 4,
            top - 4, THUMBNAIL + 8, THUMBNAIL + 8);
    fprintf(page->html, "<image href=\"%s\" x=\"%.1f\" y=\"%.1f\" width=\"%d\" height=\"%d\"/></g>", point->picture,
            left, top, THUMBNAIL, THUMBNAIL);
}

static void draw_point(weft_page *page, const weft_plot_point *point, double x, double y, taken_boxes *taken)
{
    fprintf(page->html, "<a class=\"point colour%d\" href=\"#%s\"><title>", point->colour, point->target);
    weft_page_text(page, point->label);
    fputs("</title>", page->html);
    if (point->is_marked)
        fprintf(page->html, "<circle class=\"mark\" cx=\"%.1f\" cy=\"%.1f\" r=\"%d\"/>", x, y, MARK_RADIUS);
    fprintf(page->html,
            "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%d\"/><text class=\"number\" x=\"%.1f\" y=\"%.1f\">%d</text>", x, y,
            RADIUS, x, y + 3.5, point->number);
    if (point->is_marked)
        draw_label(page, point, x, y, taken);
    if (point->picture)
        draw_thumbnail(page, point, x, y);
    fputs("</a>\n", page->html);
}

/* The marked ones lie above the others. */
static void draw_points(weft_page *page, const weft_plot *plot, const log_axis *x, const log_axis *y, bool marked)
{
    taken_boxes taken = points_of(plot, x, y);
    for (int i = 0; i < plot->point_count; i++) {
        const weft_plot_point *point = &plot->point[i];
        if (is_shown(point) && point->is_marked == marked)
            draw_point(page, point, place_on(x, point->x), place_on(y, point->y), &taken);
    }
}

weft_code weft_plot_write(weft_page *page, const weft_plot *plot, weft_error *error)
{
    log_axis x = fit_axis(plot, false), y = fit_axis(plot, true);
    if (!isfinite(x.low))
        return WEFT_OK;
    fprintf(page->html, "<svg class=\"plot wide\" viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"", WIDTH, HEIGHT);
    weft_page_text(page, plot->title);
    fputs("\">\n", page->html);
    draw_frame(page, plot, &x, &y);
    weft_code code = draw_front(page, plot, &x, &y, error);
    draw_points(page, plot, &x, &y, false);
    draw_points(page, plot, &x, &y, true);
    fputs("</svg>\n", page->html);
    return code;
}
