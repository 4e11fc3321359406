#include "base/text/chart.h"

#include <math.h>

enum { WIDTH = 560, HEIGHT = 270, LEFT = 66, RIGHT = 16, TOP = 54, BOTTOM = 46, TICKS = 5 };

/* ---- Axes ---- */

/* From `low` to `high`, both ticks, over so many pixels. */
typedef struct linear_axis {
    double low, high, step;
    double start, length;
} linear_axis;

static bool has_place(const double point[2])
{
    return isfinite(point[0]) && isfinite(point[1]);
}

/* The least of 1, 2 and 5 times a power of ten that makes at most TICKS steps of the range. */
static double choose_step(double range)
{
    double power = pow(10, floor(log10(range / TICKS))), steps = range / TICKS / power;
    return power * (steps <= 1 ? 1 : steps <= 2 ? 2 : steps <= 5 ? 5 : 10);
}

/* The axis for coordinate 0 (x) or 1 (y) of all points. */
static linear_axis fit_axis(const weft_chart *chart, int coordinate)
{
    const weft_chart_axis *least = coordinate ? &chart->y : &chart->x;
    double low = least->low, high = least->high;
    for (int s = 0; s < chart->series_count; s++) {
        for (int i = 0; i < chart->series[s].point_count; i++) {
            const double *point = chart->series[s].point[i];
            low = has_place(point) ? fmin(low, point[coordinate]) : low;
            high = has_place(point) ? fmax(high, point[coordinate]) : high;
        }
    }
    double step = fmax(choose_step(high > low ? high - low : 1), least->least_step);
    linear_axis axis = {step * floor(low / step + 1e-9), step * ceil(high / step - 1e-9), step, LEFT,
                        WIDTH - LEFT - RIGHT};
    if (!(axis.high > axis.low))
        axis.high = axis.low + step;
    if (coordinate) {
        axis.start = HEIGHT - BOTTOM;
        axis.length = -(HEIGHT - TOP - BOTTOM);
    }
    return axis;
}

static double place_on(const linear_axis *axis, double value)
{
    return axis->start + axis->length * (value - axis->low) / (axis->high - axis->low);
}

static void draw_tick(weft_page *page, const linear_axis *axis, bool vertical, double value, const char *unit)
{
    double at = place_on(axis, value);
    if (vertical)
        fprintf(page->html, "<path d=\"M%d %.1fH%d\"/><text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%.4g", LEFT, at,
                WIDTH - RIGHT, LEFT - 7, at + 4, value);
    else
        fprintf(page->html, "<path d=\"M%.1f %dV%d\"/><text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%.4g", at, TOP,
                HEIGHT - BOTTOM, at, HEIGHT - BOTTOM + 17, value);
    weft_page_text(page, unit);
    fputs("</text>", page->html);
}

static void draw_axis(weft_page *page, const linear_axis *axis, bool vertical, const char *unit)
{
    int count = (int)lround((axis->high - axis->low) / axis->step);
    for (int i = 0; i <= count; i++) {
        double value = axis->low + i * axis->step;
        draw_tick(page, axis, vertical, fabs(value) < 1e-9 * axis->step ? 0 : value, unit);
    }
}

static void draw_frame(weft_page *page, const weft_chart *chart, const linear_axis *x, const linear_axis *y)
{
    fputs("<g class=\"grid\">", page->html);
    draw_axis(page, x, false, chart->x.unit);
    draw_axis(page, y, true, chart->y.unit);
    fprintf(page->html, "</g>\n<text x=\"%d\" y=\"20\" class=\"title\">", LEFT);
    weft_page_text(page, chart->title);
    fprintf(page->html, "</text><text class=\"axis\" x=\"%d\" y=\"%d\" text-anchor=\"end\">", WIDTH - RIGHT,
            HEIGHT - 8);
    weft_page_text(page, chart->x.label);
    fprintf(page->html,
            "</text><text class=\"axis\" x=\"14\" y=\"%d\" text-anchor=\"end\" transform=\"rotate(-90 14 %d)\">", TOP,
            TOP);
    weft_page_text(page, chart->y.label);
    fputs("</text>\n", page->html);
}

/* ---- Series ---- */

/* Names in their colours in one line below the title. */
static void draw_key(weft_page *page, const weft_chart *chart)
{
    fprintf(page->html, "<text x=\"%d\" y=\"40\">", LEFT);
    for (int s = 0; s < chart->series_count; s++) {
        if (!chart->series[s].name)
            continue;
        fprintf(page->html, "<tspan class=\"key colour%d\">\u25cf </tspan><tspan dx=\"2\">", chart->series[s].colour);
        weft_page_text(page, chart->series[s].name);
        fputs("</tspan><tspan dx=\"14\"> </tspan>", page->html);
    }
    fputs("</text>\n", page->html);
}

static void draw_line(weft_page *page, const weft_chart_series *series, const linear_axis *x, const linear_axis *y)
{
    char begin = 'M';
    fprintf(page->html, "<path class=\"curve colour%d\" d=\"", series->colour);
    for (int i = 0; i < series->point_count; i++) {
        if (!has_place(series->point[i]))
            continue;
        fprintf(page->html, "%c%.1f %.1f", begin, place_on(x, series->point[i][0]), place_on(y, series->point[i][1]));
        begin = 'L';
    }
    fputs("\"/>\n", page->html);
}

static void draw_points(weft_page *page, const weft_chart *chart, const weft_chart_series *series, const linear_axis *x,
                        const linear_axis *y)
{
    for (int i = 0; i < series->point_count; i++) {
        const double *point = series->point[i];
        if (!has_place(point))
            continue;
        fprintf(page->html, "<circle class=\"colour%d\" cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\"><title>", series->colour,
                place_on(x, point[0]), place_on(y, point[1]));
        if (series->name) {
            weft_page_text(page, series->name);
            fputs(", ", page->html);
        }
        fprintf(page->html, "%.4g", point[0]);
        weft_page_text(page, chart->x.unit);
        fprintf(page->html, ": %.4g", point[1]);
        weft_page_text(page, chart->y.unit);
        fputs("</title></circle>\n", page->html);
    }
}

static bool has_points(const weft_chart *chart)
{
    for (int s = 0; s < chart->series_count; s++) {
        for (int i = 0; i < chart->series[s].point_count; i++) {
            if (has_place(chart->series[s].point[i]))
                return true;
        }
    }
    return false;
}

void weft_chart_write(weft_page *page, const weft_chart *chart)
{
    if (!has_points(chart))
        return;
    linear_axis x = fit_axis(chart, 0), y = fit_axis(chart, 1);
    fprintf(page->html, "<svg class=\"plot\" viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"", WIDTH, HEIGHT);
    weft_page_text(page, chart->title);
    fputs("\">\n", page->html);
    draw_frame(page, chart, &x, &y);
    draw_key(page, chart);
    for (int s = 0; s < chart->series_count; s++) {
        if (chart->series[s].is_line)
            draw_line(page, &chart->series[s], &x, &y);
        draw_points(page, chart, &chart->series[s], &x, &y);
    }
    fputs("</svg>\n", page->html);
}
