/* Colour charts: where their patches lie, and what colours these are. */
#ifndef WEFT_REGISTRATION_COLOUR_CHART_H
#define WEFT_REGISTRATION_COLOUR_CHART_H

enum { WEFT_CHART_COLUMNS = 6, WEFT_CHART_ROWS = 4, WEFT_CHART_PATCHES = 24, WEFT_CHART_FIRST_GREY = 18 };

typedef enum weft_chart_kind {
    WEFT_CHART_CLASSIC,      /* ColorChecker Classic, Passport or Mini made since November 2014 */
    WEFT_CHART_CLASSIC_2005, /* made before */
    WEFT_CHART_SG            /* ColorChecker Digital SG: the 24 patches E2 to J5 in its middle */
} weft_chart_kind;

/* "classic", "classic-2005", "sg", NULL. */
extern const char *const weft_chart_word[];

/* "dark skin", ..., "black": in rows from the top left, as seen with the row of greys at the bottom, white first. */
extern const char *const weft_chart_patch_name[WEFT_CHART_PATCHES];

/* The cells of a chart: all patches that it has, and the cell of the first of the 24. */
typedef struct weft_chart_layout {
    int columns, rows, left, top;
} weft_chart_layout;

/* Pure. */
weft_chart_layout weft_chart_layout_of(weft_chart_kind kind);

/* A colour of each of the 24 patches. */
typedef struct weft_chart_colours {
    double rgb[WEFT_CHART_PATCHES][3];
} weft_chart_colours;

/* Linear sRGB of the 24 patches, a perfect white diffuser being 1: the values that the maker publishes, CIE Lab under
 * D50 for the observer of 1931, adapted to D65. Pure. */
weft_chart_colours weft_chart_reference(weft_chart_kind kind);

#endif
