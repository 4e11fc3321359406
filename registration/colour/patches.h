/* The patches of a chart in a photograph. */
#ifndef WEFT_REGISTRATION_COLOUR_PATCHES_H
#define WEFT_REGISTRATION_COLOUR_PATCHES_H

#include "base/picture/image.h"
#include "registration/colour/chart.h"
#include "registration/colour/chart_library.h"

#include <stdbool.h>

/* ---- The photograph of a chart: its values in proportion to light ---- */

typedef struct weft_chart_shot {
    weft_image light; /* in proportion to light, 1 at full scale; of a file with a tone curve, as if that were sRGB's */
    bool has_tone;    /* an integer file that was not said to be linear: its tone curve is still to be found */
    float clipped_at; /* value of `light` from which one is clipped */
    bool is_scaled;   /* 1 is what the sensor holds; floats may have any scale */
} weft_chart_shot;

/* Reads a photograph of any kind that Weft reads, or the first photograph taken of a session, above black and without
 * the vignetting of the session's camera. `linear`: integer files hold linear values. The caller frees with
 * weft_image_free(&shot->light). Errors: WEFT_BAD_INPUT naming the file; WEFT_SYSTEM. */
weft_code weft_chart_shot_read(const char *path, bool linear, weft_chart_shot *shot, weft_error *error);

typedef struct weft_chart_patch {
    double light[3]; /* mean of the middle of the patch, as in the shot */
    double clipped;  /* share of its pixels that are clipped in a channel */
    double pixel[2]; /* its centre */
} weft_chart_patch;

/* Finds the chart, whichever way up it lies, and measures its patches: of the pixels of the middle half of a patch, in
 * each channel, the mean without the lowest and the highest fifth (glare, dust, a scratch). Errors: WEFT_BAD_INPUT
 * naming `path` where no chart is found, or one that is mirrored or covered; WEFT_SYSTEM. */
weft_code weft_chart_find(const weft_chart_shot *shot, const char *path, weft_chart_kind kind,
                          weft_chart_patch patch[WEFT_CHART_PATCHES], weft_error *error);

/* ---- The grid of a chart's cells in a photograph ---- */

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
