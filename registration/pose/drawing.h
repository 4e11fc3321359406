/* The target as a fine raster of its drawing, ready to be asked what the pixels of a photograph see of it. */
#ifndef WEFT_REGISTRATION_POSE_DRAWING_H
#define WEFT_REGISTRATION_POSE_DRAWING_H

#include "base/status.h"
#include "btf/session/target.h"

#include <stdbool.h>
#include <stdint.h>

/* Cells are squares of cell_mm; cell (0, 0) has its lower left corner at (-half_mm, -half_mm), rows go up. */
typedef struct weft_drawing {
    int side;                /* cells */
    double cell_mm, half_mm; /* half_mm = side x cell_mm / 2, beyond the plate on every side */
    float *reflectance;      /* [side][side] diffuse reflectance averaged over the cell */
    uint32_t (*sums)[2]; /* [side + 1][side + 1] summed-area tables, of the cells whose reflectance varies around them,
                            and of those that are not print or reference: the opening and what is off the plate */
} weft_drawing;

/* What a rectangle of the plate holds. */
typedef struct weft_drawing_content {
    bool excluded; /* something of the opening or of the world beyond the plate */
    bool uniform;  /* one reflectance throughout; not looked at where something is excluded */
} weft_drawing_content;

/* Draws the target with cells of about `cell_mm`, at most 4096 a side. The caller frees it with weft_drawing_free;
 * once drawn it is immutable. Errors: WEFT_BAD_INPUT for a target without size, WEFT_SYSTEM for memory. */
weft_code weft_drawing_create(const weft_target *target, double cell_mm, weft_drawing *drawing, weft_error *error);
void weft_drawing_free(weft_drawing *drawing);

/* Content of a rectangle, mm; what lies beyond the raster is excluded. Conservative by one cell. Pure. */
weft_drawing_content weft_drawing_content_of(const weft_drawing *drawing, weft_rectangle rectangle);

/* Reflectance at a place in cells from the centre of the first, which must lie inside the raster: bilinear. Pure. */
static inline float weft_drawing_between(const weft_drawing *drawing, float x, float y)
{
    int column = (int)x, row = (int)y;
    float fx = x - (float)column, fy = y - (float)row;
    int at = row * drawing->side + column;
    const float *cell = drawing->reflectance;
    float low = cell[at] + fx * (cell[at + 1] - cell[at]);
    float high = cell[at + drawing->side] + fx * (cell[at + drawing->side + 1] - cell[at + drawing->side]);
    return low + fy * (high - low);
}

/* Reflectance at a point of the plate, mm; beyond the raster that of its border. Pure. */
static inline float weft_drawing_at(const weft_drawing *drawing, float x_mm, float y_mm)
{
    float limit = (float)drawing->side - 1.01f, cells = 1 / (float)drawing->cell_mm;
    float x = (x_mm + (float)drawing->half_mm) * cells - 0.5f;
    float y = (y_mm + (float)drawing->half_mm) * cells - 0.5f;
    x = x > 0 ? x : 0;
    y = y > 0 ? y : 0;
    return weft_drawing_between(drawing, x < limit ? x : limit, y < limit ? y : limit);
}

#endif
