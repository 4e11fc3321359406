/* Points and curves over two axes, as SVG in a page, with a legend beside them. */
#ifndef WEFT_BASE_TEXT_CHART_H
#define WEFT_BASE_TEXT_CHART_H

#include "base/text/html_page.h"

#include <stdbool.h>

typedef enum weft_chart_style {
    WEFT_CHART_POINTS,
    WEFT_CHART_LINE,  /* points joined in their order */
    WEFT_CHART_STEPS, /* a dashed staircase, without discs */
    WEFT_CHART_RINGS  /* around points of other series */
} weft_chart_style;

/* What a point is: shown when pointed at, in place of its coordinates. */
typedef struct weft_chart_note {
    const char *text;
    const char *target; /* id of the element of the page that a click leads to */
} weft_chart_note;

/* Points of one colour. One that has no finite place is left out; a line then goes on at the next. */
typedef struct weft_chart_series {
    const char *name; /* text, in the legend; NULL: not there */
    int colour;       /* 0..6, of the style of the page */
    weft_chart_style style;
    int point_count;
    const double (*point)[2];    /* x and y */
    const weft_chart_note *note; /* [point_count]; NULL: none */
} weft_chart_series;

/* An axis shows its range and whatever points lie beyond, to the next tick. */
typedef struct weft_chart_axis {
    const char *label, *unit; /* text; the unit, such as " %", follows the number of every tick */
    double low, high;         /* shown at least, on linear axes */
    double least_step;        /* between ticks of linear axes: 1 of what is counted; 0: any */
} weft_chart_axis;

typedef struct weft_chart {
    const char *title; /* text */
    weft_chart_axis x, y;
    int series_count;
    const weft_chart_series *series;
} weft_chart;

/* Writes the chart; nothing where no point has a place. */
void weft_chart_write(weft_page *page, const weft_chart *chart);

/* The same over logarithmic axes, for values above 0: a point without has no place. */
void weft_chart_write_logarithmic(weft_page *page, const weft_chart *chart);

#endif
