/* The plane z = 0 but for the opening: the printed sheet and the table round it. */
#ifndef WEFT_CAPTURE_SYNTHETIC_SHEET_H
#define WEFT_CAPTURE_SYNTHETIC_SHEET_H

#include "btf/session/target.h"

#include <stdbool.h>
#include <stdint.h>

enum { WEFT_SYNTHETIC_CELLS_X = 124, WEFT_SYNTHETIC_CELLS_Y = 168 };

/* Every edge of the print lies on a line between two cells of a 32nd of the opening. */
typedef struct weft_synthetic_sheet {
    weft_target target;
    bool is_there; /* else a table with a checked cloth on it */
    double cell_mm;
    double margin_mm;                                           /* of bare paper round the print */
    uint64_t seed;                                              /* of the table's texture */
    float cell[WEFT_SYNTHETIC_CELLS_Y][WEFT_SYNTHETIC_CELLS_X]; /* reflectance; negative in the opening */
} weft_synthetic_sheet;

weft_synthetic_sheet weft_synthetic_sheet_of(double opening_mm, bool is_there, uint64_t seed);

/* Diffuse reflectance at a point; negative in the opening. Pure. */
double weft_synthetic_sheet_reflectance(const weft_synthetic_sheet *sheet, double x_mm, double y_mm);

/* Whether no edge crosses the square of points within `reach_mm` in x and y. Pure. */
bool weft_synthetic_sheet_is_even(const weft_synthetic_sheet *sheet, double x_mm, double y_mm, double reach_mm);

#endif
