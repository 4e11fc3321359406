#include "capture/synthetic/scene.h"

#include "capture/virtual/random.h"

static const double table_grey = 0.33;

static float cell_reflectance(const weft_target *target, double x, double y)
{
    if (weft_target_region_at(target, x, y) == WEFT_TARGET_OPENING)
        return -1;
    return (float)weft_target_sheet_reflectance(target, x, y);
}

weft_synthetic_sheet weft_synthetic_sheet_of(double opening_mm, bool is_there, uint64_t seed)
{
    weft_synthetic_sheet sheet = {.target = weft_target_printed(opening_mm),
                                  .is_there = is_there,
                                  .cell_mm = opening_mm / 32,
                                  .margin_mm = 5,
                                  .seed = seed};
    for (int row = 0; row < WEFT_SYNTHETIC_CELLS_Y; row++) {
        for (int column = 0; column < WEFT_SYNTHETIC_CELLS_X; column++) {
            double x = (column + 0.5 - WEFT_SYNTHETIC_CELLS_X / 2.0) * sheet.cell_mm;
            double y = (row + 0.5 - WEFT_SYNTHETIC_CELLS_Y / 2.0) * sheet.cell_mm;
            sheet.cell[row][column] = cell_reflectance(&sheet.target, x, y);
        }
    }
    return sheet;
}

/* ---- The table ---- */

static double lattice(uint64_t seed, long x, long y)
{
    uint32_t h = (uint32_t)seed ^ (uint32_t)x * 0x9e3779b1u ^ (uint32_t)y * 0x85ebca77u;
    h = (h ^ h >> 16) * 0x7feb352du;
    h = (h ^ h >> 15) * 0x846ca68bu;
    return (double)(h ^ h >> 16) * 0x1p-32;
}

static double smooth(double t)
{
    return t * t * (3 - 2 * t);
}

/* Value noise between 0 and 1 (Perlin 1985 smooths so). */
static double noise(uint64_t seed, double x, double y)
{
    double fx = floor(x), fy = floor(y), u = smooth(x - fx), v = smooth(y - fy);
    long i = (long)fx, j = (long)fy;
    double low = lattice(seed, i, j) * (1 - u) + lattice(seed, i + 1, j) * u;
    double high = lattice(seed, i, j + 1) * (1 - u) + lattice(seed, i + 1, j + 1) * u;
    return low * (1 - v) + high * v;
}

/* Grained across x, as wood is. */
static double table_reflectance(const weft_synthetic_sheet *sheet, double x, double y)
{
    double grain = noise(sheet->seed, x / 60, y / 2.5) - 0.5, blot = noise(sheet->seed + 1, x / 45, y / 30) - 0.5;
    return table_grey * (1 + 0.2 * grain + 0.25 * blot);
}

/* Another scene: a checked cloth on the table. */
static double other_reflectance(const weft_synthetic_sheet *sheet, double x, double y)
{
    const double half = 2.2 * sheet->target.opening_mm, check = 11;
    if (fabs(x) > half || fabs(y) > half)
        return table_reflectance(sheet, x, y);
    return 0.12 + 0.25 * (fmod(floor(x / check), 2) != 0) + 0.25 * (fmod(floor(y / check), 3) != 0);
}

/* ---- The plane ---- */

double weft_synthetic_sheet_reflectance(const weft_synthetic_sheet *sheet, double x_mm, double y_mm)
{
    if (!sheet->is_there)
        return other_reflectance(sheet, x_mm, y_mm);
    double column = x_mm / sheet->cell_mm + WEFT_SYNTHETIC_CELLS_X / 2.0;
    double row = y_mm / sheet->cell_mm + WEFT_SYNTHETIC_CELLS_Y / 2.0;
    if (column >= 0 && column < WEFT_SYNTHETIC_CELLS_X && row >= 0 && row < WEFT_SYNTHETIC_CELLS_Y)
        return (double)sheet->cell[(int)row][(int)column];
    double half_x = WEFT_SYNTHETIC_CELLS_X / 2.0 * sheet->cell_mm + sheet->margin_mm;
    double half_y = WEFT_SYNTHETIC_CELLS_Y / 2.0 * sheet->cell_mm + sheet->margin_mm;
    if (fabs(x_mm) < half_x && fabs(y_mm) < half_y)
        return sheet->target.paper_reflectance;
    return table_reflectance(sheet, x_mm, y_mm);
}

/* 1: on the print; 0: on the margin; -1: on the table; -2: across an edge of these. */
static int place_of(const weft_synthetic_sheet *sheet, double x, double y, double reach)
{
    double print_x = WEFT_SYNTHETIC_CELLS_X / 2.0 * sheet->cell_mm,
           print_y = WEFT_SYNTHETIC_CELLS_Y / 2.0 * sheet->cell_mm;
    double page_x = print_x + sheet->margin_mm, page_y = print_y + sheet->margin_mm;
    x = fabs(x);
    y = fabs(y);
    if (x - reach > page_x || y - reach > page_y)
        return -1;
    if (x + reach >= page_x || y + reach >= page_y)
        return -2;
    if (x - reach > print_x || y - reach > print_y)
        return 0;
    return x + reach < print_x && y + reach < print_y ? 1 : -2;
}

static bool cells_agree(const weft_synthetic_sheet *sheet, double x, double y, double reach)
{
    double middle_x = WEFT_SYNTHETIC_CELLS_X / 2.0, middle_y = WEFT_SYNTHETIC_CELLS_Y / 2.0;
    int x0 = (int)((x - reach) / sheet->cell_mm + middle_x), x1 = (int)((x + reach) / sheet->cell_mm + middle_x);
    int y0 = (int)((y - reach) / sheet->cell_mm + middle_y), y1 = (int)((y + reach) / sheet->cell_mm + middle_y);
    for (int row = y0; row <= y1; row++) {
        for (int column = x0; column <= x1; column++) {
            if (sheet->cell[row][column] != sheet->cell[y0][x0])
                return false;
        }
    }
    return true;
}

bool weft_synthetic_sheet_is_even(const weft_synthetic_sheet *sheet, double x_mm, double y_mm, double reach_mm)
{
    if (!sheet->is_there)
        return fabs(x_mm) > 3 * sheet->target.opening_mm || fabs(y_mm) > 3 * sheet->target.opening_mm;
    int place = place_of(sheet, x_mm, y_mm, reach_mm);
    return place == 1 ? cells_agree(sheet, x_mm, y_mm, reach_mm) : place != -2;
}
