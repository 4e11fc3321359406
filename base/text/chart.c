#include "base/text/chart.h"

#include <math.h>

enum { WIDTH = 560, LEGEND = 200, HEIGHT = 270, LEFT = 66, RIGHT = 16, TOP = 34, BOTTOM = 46, TICKS = 5, LINE = 18 };

/* ---- Axes ---- */

/* From `low` to `high` over so many pixels. */
typedef struct chart_axis {
    bool is_logarithmic;
    double low, high;
    double step; /* between the ticks of a linear axis, whose ends are ticks */
    double start, length;
} chart_axis;

static bool has_place(const chart_axis *axis, const double point[2])
{
    return isfinite(point[0]) && isfinite(point[1]) && (!axis->is_logarithmic || (point[0] > 0 && point[1] > 0));
}

/* The least of 1, 2 and 5 times a power of ten that makes at most TICKS steps of the range. */
static double choose_step(double range)
{
    double power = pow(10, floor(log10(range / TICKS))), steps = range / TICKS / power;
    return power * (steps <= 1 ? 1 : steps <= 2 ? 2 : steps <= 5 ? 5 : 10);
}

static void end_at_ticks(chart_axis *axis, double least_step)
{
    axis->step = fmax(choose_step(axis->high > axis->low ? axis->high - axis->low : 1), least_step);
    axis->low = axis->step * floor(axis->low / axis->step + 1e-9);
    axis->high = axis->step * ceil(axis->high / axis->step - 1e-9);
    if (!(axis->high > axis->low))
        axis->high = axis->low + axis->step;
}

/* A little beyond the outermost points, and at least a factor of two. */
static void widen(chart_axis *axis)
{
    double margin = fmax(pow(axis->high / axis->low, 0.07), sqrt(2 * axis->low / axis->high));
    axis->low /= margin;
    axis->high *= margin;
}

/* The axis for coordinate 0 (x) or 1 (y) of all points. */
static chart_axis fit_axis(const weft_chart *chart, int coordinate, bool logarithmic)
{
    const weft_chart_axis *least = coordinate ? &chart->y : &chart->x;
    chart_axis axis = {logarithmic,         logarithmic ? INFINITY : least->low, logarithmic ? 0 : least->high, 0, LEFT,
                       WIDTH - LEFT - RIGHT};
    for (int s = 0; s < chart->series_count; s++) {
        for (int i = 0; i < chart->series[s].point_count; i++) {
            const double *point = chart->series[s].point[i];
            axis.low = has_place(&axis, point) ? fmin(axis.low, point[coordinate]) : axis.low;
            axis.high = has_place(&axis, point) ? fmax(axis.high, point[coordinate]) : axis.high;
        }
    }
    if (logarithmic)
        widen(&axis);
    else
        end_at_ticks(&axis, least->least_step);
    if (coordinate) {
        axis.start = HEIGHT - BOTTOM;
        axis.length = -(HEIGHT - TOP - BOTTOM);
    }
    return axis;
}

static double place_on(const chart_axis *axis, double value)
{
    double share = axis->is_logarithmic ? log(value / axis->low) / log(axis->high / axis->low)
                                        : (value - axis->low) / (axis->high - axis->low);
    return axis->start + axis->length * share;
}

static void draw_tick(weft_page *page, const chart_axis *axis, bool vertical, double value, const char *unit)
{
    double at = place_on(axis, value);
    const char *prefix = "";
    for (int i = 0; i < 3 && axis->is_logarithmic && fabs(value) >= 999; i++) {
        value /= 1000;
        prefix = &"k\0M\0G"[2 * i];
    }
    if (vertical)
        fprintf(page->html, "<path d=\"M%d %.1fH%d\"/><text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%.4g%s", LEFT, at,
                WIDTH - RIGHT, LEFT - 7, at + 4, value, prefix);
    else
        fprintf(page->html, "<path d=\"M%.1f %dV%d\"/><text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%.4g%s", at, TOP,
                HEIGHT - BOTTOM, at, HEIGHT - BOTTOM + 17, value, prefix);
    weft_page_text(page, unit);
    fputs("</text>", page->html);
}

/* At powers of ten; at more of their multiples over a short axis than over a long one. */
static void draw_logarithmic_axis(weft_page *page, const chart_axis *axis, bool vertical, const char *unit)
{
    static const double multiple[] = {1, 2, 5, 1.5, 3, 4, 7};
    double decades = log10(axis->high / axis->low);
    int multiples = decades > 3.5 ? 1 : decades > 1 ? 3 : 7;
    for (int power = (int)floor(log10(axis->low)); power <= (int)floor(log10(axis->high)); power++) {
        for (int i = 0; i < multiples; i++) {
            double value = multiple[i] * pow(10, power);
            if (value >= axis->low && value <= axis->high)
                draw_tick(page, axis, vertical, value, unit);
        }
    }
}

static void draw_axis(weft_page *page, const chart_axis *axis, bool vertical, const char *unit)
{
    if (axis->is_logarithmic) {
        draw_logarithmic_axis(page, axis, vertical, unit);
        return;
    }
    int count = (int)lround((axis->high - axis->low) / axis->step);
    for (int i = 0; i <= count; i++) {
        double value = axis->low + i * axis->step;
        draw_tick(page, axis, vertical, fabs(value) < 1e-9 * axis->step ? 0 : value, unit);
    }
}

static void draw_frame(weft_page *page, const weft_chart *chart, const chart_axis *x, const chart_axis *y)
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

static bool is_empty(const weft_chart_series *series, const chart_axis *x)
{
    for (int i = 0; i < series->point_count; i++) {
        if (has_place(x, series->point[i]))
            return false;
    }
    return true;
}

static void draw_legend(weft_page *page, const weft_chart *chart, const chart_axis *x)
{
    int y = TOP + LINE / 2;
    for (int s = 0; s < chart->series_count; s++) {
        const weft_chart_series *series = &chart->series[s];
        if (!series->name || is_empty(series, x))
            continue;
        fprintf(page->html, "<text x=\"%d\" y=\"%d\"><tspan class=\"key colour%d\">%s </tspan>", WIDTH, y,
                series->colour,
                series->style == WEFT_CHART_STEPS   ? "\u254c"
                : series->style == WEFT_CHART_RINGS ? "\u25cb"
                                                    : "\u25cf");
        weft_page_text(page, series->name);
        fputs("</text>\n", page->html);
        y += LINE;
    }
}

static void draw_line(weft_page *page, const weft_chart_series *series, const chart_axis *x, const chart_axis *y)
{
    bool is_first = true, is_steps = series->style == WEFT_CHART_STEPS;
    fprintf(page->html, "<path class=\"%s colour%d\" d=\"", is_steps ? "steps" : "curve", series->colour);
    for (int i = 0; i < series->point_count; i++) {
        if (!has_place(x, series->point[i]))
            continue;
        fprintf(page->html,
                is_first   ? "M%.1f %.1f"
                : is_steps ? "H%.1fV%.1f"
                           : "L%.1f %.1f",
                place_on(x, series->point[i][0]), place_on(y, series->point[i][1]));
        is_first = false;
    }
    fputs("\"/>\n", page->html);
}

static void put_title(weft_page *page, const weft_chart *chart, const weft_chart_series *series, int i)
{
    fputs("<title>", page->html);
    if (series->note || series->name) {
        weft_page_text(page, series->note ? series->note[i].text : series->name);
        fputs(", ", page->html);
    }
    fprintf(page->html, "%.4g", series->point[i][0]);
    weft_page_text(page, chart->x.unit);
    fprintf(page->html, ": %.4g", series->point[i][1]);
    weft_page_text(page, chart->y.unit);
    fputs("</title>", page->html);
}

static void draw_points(weft_page *page, const weft_chart *chart, const weft_chart_series *series, const chart_axis *x,
                        const chart_axis *y)
{
    for (int i = 0; i < series->point_count; i++) {
        const double *point = series->point[i];
        if (!has_place(x, point))
            continue;
        if (series->note)
            fprintf(page->html, "<a href=\"#%s\">", series->note[i].target);
        fprintf(page->html, "<circle class=\"%scolour%d\" cx=\"%.1f\" cy=\"%.1f\" r=\"%s\">",
                series->style == WEFT_CHART_RINGS ? "mark " : "", series->colour, place_on(x, point[0]),
                place_on(y, point[1]), series->style == WEFT_CHART_RINGS ? "7" : "3.5");
        put_title(page, chart, series, i);
        fputs(series->note ? "</circle></a>\n" : "</circle>\n", page->html);
    }
}

static void write_chart(weft_page *page, const weft_chart *chart, bool logarithmic)
{
    chart_axis x = fit_axis(chart, 0, logarithmic), y = fit_axis(chart, 1, logarithmic);
    bool is_nothing = true, has_legend = false;
    for (int s = 0; s < chart->series_count; s++) {
        is_nothing &= is_empty(&chart->series[s], &x);
        has_legend |= chart->series[s].name != NULL;
    }
    if (is_nothing)
        return;
    fprintf(page->html, "<svg class=\"plot\" viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"",
            has_legend ? WIDTH + LEGEND : WIDTH, HEIGHT);
    weft_page_text(page, chart->title);
    fputs("\">\n", page->html);
    draw_frame(page, chart, &x, &y);
    draw_legend(page, chart, &x);
    for (int s = 0; s < chart->series_count; s++) {
        const weft_chart_series *series = &chart->series[s];
        if (series->style == WEFT_CHART_LINE || series->style == WEFT_CHART_STEPS)
            draw_line(page, series, &x, &y);
        if (series->style != WEFT_CHART_STEPS)
            draw_points(page, chart, series, &x, &y);
    }
    fputs("</svg>\n", page->html);
}

void weft_chart_write(weft_page *page, const weft_chart *chart)
{
    write_chart(page, chart, false);
}

void weft_chart_write_logarithmic(weft_page *page, const weft_chart *chart)
{
    write_chart(page, chart, true);
}
