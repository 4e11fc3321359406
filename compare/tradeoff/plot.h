/* A scatter of points over logarithmic axes, as SVG in a page. */
#ifndef WEFT_COMPARE_TRADEOFF_PLOT_H
#define WEFT_COMPARE_TRADEOFF_PLOT_H

#include "base/text/html_page.h"

#include <stdbool.h>

typedef struct weft_plot_point {
    double x, y;         /* above 0, else the point is left out */
    int number;          /* in its disc */
    int colour;          /* 0..6, of the style "plot" */
    const char *label;   /* text; beside the point where it is marked, else shown when pointed at */
    const char *picture; /* a file of the page, shown when pointed at; NULL: none */
    const char *target;  /* anchor in the page that a click leads to */
    bool is_marked;      /* ringed, and labelled */
    bool is_joined;      /* by a line with the others that are, from left to right */
} weft_plot_point;

typedef struct weft_plot {
    const char *title, *x_label, *y_label; /* text */
    int point_count;
    const weft_plot_point *point;
} weft_plot;

/* Writes the plot; nothing where no point has both coordinates. Errors: WEFT_SYSTEM for memory. */
weft_code weft_plot_write(weft_page *page, const weft_plot *plot, weft_error *error);

#endif
