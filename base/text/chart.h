/* Points and curves over linear axes, as SVG in a page. */
#ifndef WEFT_BASE_TEXT_CHART_H
#define WEFT_BASE_TEXT_CHART_H

#include "base/text/html_page.h"

#include <stdbool.h>

/* Points of one colour. One that has no finite place is left out; a line then goes on at the next. */
typedef struct weft_chart_series {
    const char *name; /* text, in the key of the chart; NULL: not there */
    int colour;       /* 0..4, of the style of the page */
    bool is_line;     /* joined in their order */
    int point_count;
    const double (*point)[2]; /* x and y */
} weft_chart_series;

/* An axis shows its range and whatever points lie beyond, to the next tick. */
typedef struct weft_chart_axis {
    const char *label, *unit; /* text; the unit, such as " %", follows the number of every tick */
    double low, high;         /* shown at least */
    double least_step;        /* between ticks: 1 of what is counted; 0: any */
} weft_chart_axis;

typedef struct weft_chart {
    const char *title; /* text */
    weft_chart_axis x, y;
    int series_count;
    const weft_chart_series *series;
} weft_chart;

/* Writes the chart; nothing where no point has a place. */
void weft_chart_write(weft_page *page, const weft_chart *chart);

#endif
