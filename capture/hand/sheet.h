/* The plane z = 0 but for the opening: the printed sheet and the table round it. */
#ifndef WEFT_CAPTURE_HAND_SHEET_H
#define WEFT_CAPTURE_HAND_SHEET_H

#include "btf/session/target.h"

#include <stdbool.h>
#include <stdint.h>

enum { WEFT_SNAP_CELLS_X = 124, WEFT_SNAP_CELLS_Y = 168 };

/* Every edge of the print lies on a line between two cells of a 32nd of the opening. */
typedef struct weft_snap_sheet {
    weft_target target;
    bool is_there; /* else a table with a checked cloth on it */
    double cell_mm;
    double margin_mm;                                 /* of bare paper round the print */
    uint64_t seed;                                    /* of the table's texture */
    float cell[WEFT_SNAP_CELLS_Y][WEFT_SNAP_CELLS_X]; /* reflectance; negative in the opening */
} weft_snap_sheet;

weft_snap_sheet weft_snap_sheet_of(double opening_mm, bool is_there, uint64_t seed);

/* Diffuse reflectance at a point; negative in the opening. Pure. */
double weft_snap_sheet_reflectance(const weft_snap_sheet *sheet, double x_mm, double y_mm);

/* Whether no edge crosses the square of points within `reach_mm` in x and y. Pure. */
bool weft_snap_sheet_is_even(const weft_snap_sheet *sheet, double x_mm, double y_mm, double reach_mm);

#endif
