#include "registration/pose/drawing.h"

#include <math.h>
#include <stdlib.h>

enum { EDGES, EXCLUDED }; /* columns of the summed-area tables */

enum { largest_side = 4096, cell_samples = 4 };

static const double border_cells = 8;

static double centre_mm(const weft_drawing *drawing, int index)
{
    return (index + 0.5) * drawing->cell_mm - drawing->half_mm;
}

static bool is_excluded(const weft_target *target, double x, double y)
{
    weft_target_region region = weft_target_region_at(target, x, y);
    return region == WEFT_TARGET_OPENING || region == WEFT_TARGET_OUTSIDE;
}

static float area_average(const weft_target *target, double x, double y, double cell_mm)
{
    double sum = 0;
    for (int j = 0; j < cell_samples; j++) {
        for (int i = 0; i < cell_samples; i++) {
            double dx = ((i + 0.5) / cell_samples - 0.5) * cell_mm, dy = ((j + 0.5) / cell_samples - 0.5) * cell_mm;
            sum += weft_target_reflectance(target, x + dx, y + dy);
        }
    }
    return (float)(sum / (cell_samples * cell_samples));
}

static void draw_centres(const weft_target *target, weft_drawing *drawing)
{
#pragma omp parallel for schedule(static)
    for (int row = 0; row < drawing->side; row++) {
        for (int column = 0; column < drawing->side; column++)
            drawing->reflectance[(size_t)row * (size_t)drawing->side + (size_t)column] =
                (float)weft_target_reflectance(target, centre_mm(drawing, column), centre_mm(drawing, row));
    }
}

static bool varies_around(const weft_drawing *drawing, int row, int column)
{
    const float *cell = drawing->reflectance + (long)row * drawing->side + column;
    for (int dy = row > 0 ? -1 : 0; dy <= (row + 1 < drawing->side ? 1 : 0); dy++) {
        for (int dx = column > 0 ? -1 : 0; dx <= (column + 1 < drawing->side ? 1 : 0); dx++) {
            if (cell[(long)dy * drawing->side + dx] != cell[0])
                return true;
        }
    }
    return false;
}

/* Marks edges and exclusions with ones at [row + 1][column + 1], where the summed-area tables will stand. */
static void mark_cells(const weft_target *target, weft_drawing *drawing)
{
    size_t stride = (size_t)drawing->side + 1;
#pragma omp parallel for schedule(static)
    for (int row = 0; row < drawing->side; row++) {
        for (int column = 0; column < drawing->side; column++) {
            size_t at = ((size_t)row + 1) * stride + (size_t)column + 1;
            drawing->sums[at][EDGES] = varies_around(drawing, row, column);
            drawing->sums[at][EXCLUDED] = is_excluded(target, centre_mm(drawing, column), centre_mm(drawing, row));
        }
    }
}

static void smooth_edges(const weft_target *target, weft_drawing *drawing)
{
    size_t stride = (size_t)drawing->side + 1;
#pragma omp parallel for schedule(dynamic, 16)
    for (int row = 0; row < drawing->side; row++) {
        for (int column = 0; column < drawing->side; column++) {
            if (drawing->sums[((size_t)row + 1) * stride + (size_t)column + 1][EDGES])
                drawing->reflectance[(size_t)row * (size_t)drawing->side + (size_t)column] =
                    area_average(target, centre_mm(drawing, column), centre_mm(drawing, row), drawing->cell_mm);
        }
    }
}

static void integrate(uint32_t (*table)[2], int side)
{
    size_t stride = (size_t)side + 1;
    for (size_t row = 1; row < stride; row++) {
        uint32_t sum[2] = {0, 0};
        for (size_t column = 1; column < stride; column++) {
            for (int which = 0; which < 2; which++) {
                sum[which] += table[row * stride + column][which];
                table[row * stride + column][which] = table[(row - 1) * stride + column][which] + sum[which];
            }
        }
    }
}

weft_code weft_drawing_create(const weft_target *target, double cell_mm, weft_drawing *drawing, weft_error *error)
{
    double radius = weft_target_radius_mm(target);
    *drawing = (weft_drawing){0};
    if (!(radius > 0 && isfinite(radius) && cell_mm > 0))
        return weft_fail(error, WEFT_BAD_INPUT, "a target of radius %g mm cannot be drawn in cells of %g mm", radius,
                         cell_mm);
    double wanted = 2 * radius / cell_mm + 2 * border_cells;
    drawing->side = wanted < largest_side ? (int)ceil(wanted) : largest_side;
    drawing->cell_mm = 2 * radius / (drawing->side - 2 * border_cells);
    drawing->half_mm = drawing->cell_mm * drawing->side / 2;
    size_t cells = (size_t)drawing->side * (size_t)drawing->side;
    size_t corners = ((size_t)drawing->side + 1) * ((size_t)drawing->side + 1);
    drawing->reflectance = malloc(cells * sizeof *drawing->reflectance);
    drawing->sums = calloc(corners, sizeof *drawing->sums);
    if (!drawing->reflectance || !drawing->sums) {
        weft_drawing_free(drawing);
        return weft_fail_memory(error, "the drawing of the target", cells * 12);
    }
    draw_centres(target, drawing);
    mark_cells(target, drawing);
    smooth_edges(target, drawing);
    integrate(drawing->sums, drawing->side);
    return WEFT_OK;
}

void weft_drawing_free(weft_drawing *drawing)
{
    free(drawing->reflectance);
    free(drawing->sums);
    *drawing = (weft_drawing){0};
}

weft_drawing_content weft_drawing_content_of(const weft_drawing *drawing, weft_rectangle rectangle)
{
    double low = -drawing->half_mm + drawing->cell_mm, high = drawing->half_mm - drawing->cell_mm;
    if (!(rectangle.x0 > low && rectangle.y0 > low && rectangle.x1 < high && rectangle.y1 < high))
        return (weft_drawing_content){true, false};
    double cells = 1 / drawing->cell_mm, half = drawing->half_mm;
    int x0 = (int)((rectangle.x0 + half) * cells), x1 = (int)((rectangle.x1 + half) * cells) + 1;
    int y0 = (int)((rectangle.y0 + half) * cells), y1 = (int)((rectangle.y1 + half) * cells) + 1;
    const uint32_t(*top)[2] = (const uint32_t(*)[2])drawing->sums + (long)y0 * (drawing->side + 1);
    const uint32_t(*bottom)[2] = (const uint32_t(*)[2])drawing->sums + (long)y1 * (drawing->side + 1);
    uint32_t count[2];
    for (int which = 0; which < 2; which++)
        count[which] = bottom[x1][which] - top[x1][which] - bottom[x0][which] + top[x0][which];
    return (weft_drawing_content){count[EXCLUDED] > 0, count[EXCLUDED] == 0 && count[EDGES] == 0};
}
