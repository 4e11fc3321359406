/* The grid of a chart's cells in a photograph. */
#ifndef WEFT_REGISTRATION_COLOUR_GRID_H
#define WEFT_REGISTRATION_COLOUR_GRID_H

#include "base/picture/image.h"
#include "registration/colour/chart.h"
#include "registration/colour/chart_library.h"

/* Cell (column, row) covers column..column + 1, row..row + 1 of the plane that `to_pixel` maps to pixels; its patch
 * lies in the middle. */
typedef struct weft_chart_grid {
    weft_chart_layout layout;
    double to_pixel[3][3];
} weft_chart_grid;

/* Where a point of the plane is seen. Pure. */
void weft_chart_grid_see(const weft_chart_grid *grid, double column, double row, double pixel[2]);

/* The side of a cell around a point, pixels: the shorter of its two. Pure. */
double weft_chart_grid_side(const weft_chart_grid *grid, double column, double row);

/* The grid with the corners of a sighting, in the order of (0, 0), (columns, 0), (columns, rows), (0, rows). Errors:
 * WEFT_BAD_INPUT where three lie on a line; WEFT_SYSTEM. */
weft_code weft_chart_grid_of_corners(weft_chart_layout layout, const weft_chart_sighting *sighting,
                                     weft_chart_grid *grid, weft_error *error);

/* Moves the grid to where the patches are, from within a third of a cell: an area of even colour is grown from the
 * middle of each, and the grid laid through the middles of those. `rgb` [height][width][3] is a picture in which
 * neighbouring patches differ. *seen receives how many of the cells have such an area within a tenth of a cell of
 * where the grid is then. Errors: WEFT_SYSTEM. */
weft_code weft_chart_grid_refine(const uint8_t *rgb, int width, int height, weft_chart_grid *grid, int *seen,
                                 weft_error *error);

#endif
