#include "btf/session/target.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

/* Lengths in 32nds of the opening's side: the plate was drawn for an opening of 32 mm. */
static const double unit_count = 32;
static const double plate_radius = 52;
static const double marker_side = 18, outer_marker_side = 12;
static const double marker_center[WEFT_SHEET_MARKER_COUNT][2] = {
    {38, 0},   {27, 27}, {0, 38}, {-27, 27}, {-38, 0},   {-27, -27}, {0, -38},
    {27, -27}, {54, 44}, {0, 70}, {-54, 44}, {-54, -44}, {-54, -75}, {54, -44}};
static const double reference_center[4][2] = {{22.5, 0}, {0, 22.5}, {-22.5, 0}, {0, -22.5}};
static const double reference_across = 7, reference_along = 13;
static const double sheet_width = 124, sheet_height = 168;
static const double ball_place[WEFT_TARGET_BALL_COUNT][2] = {{-54, 76}, {54, -76}}, pin_place[2] = {28, 66};

/* The 4 x 4 cells of the ArUco markers 0..13 of DICT_4X4_50: rows from the top, most significant bit first, 1 = white.
 */
static const uint16_t marker_cells[WEFT_SHEET_MARKER_COUNT] = {0xb532, 0x0f9a, 0x332d, 0x9946, 0x549e, 0x79cd, 0x9e2e,
                                                               0xc4f2, 0xfeda, 0xcf56, 0xf991, 0x11a7, 0x0eb7, 0x2a0f};

weft_target weft_target_for_opening(double opening_mm)
{
    return (weft_target){opening_mm, 0.95, 0.80, 0.04};
}

weft_target weft_target_printed(double opening_mm)
{
    return (weft_target){opening_mm, 0.85, 0.85, 0.05};
}

double weft_target_radius_mm(const weft_target *target)
{
    return plate_radius / unit_count * target->opening_mm;
}

static weft_rectangle centred_rectangle(const weft_target *target, const double center[2], double width, double height)
{
    double unit = target->opening_mm / unit_count;
    return (weft_rectangle){(center[0] - width / 2) * unit, (center[1] - height / 2) * unit,
                            (center[0] + width / 2) * unit, (center[1] + height / 2) * unit};
}

weft_rectangle weft_target_sheet(const weft_target *target)
{
    return centred_rectangle(target, (const double[2]){0, 0}, sheet_width, sheet_height);
}

static void scaled_place(const weft_target *target, const double place[2], double place_mm[2])
{
    for (int axis = 0; axis < 2; axis++)
        place_mm[axis] = place[axis] * target->opening_mm / unit_count;
}

void weft_target_ball(const weft_target *target, int index, double place_mm[2])
{
    scaled_place(target, ball_place[index], place_mm);
}

void weft_target_pin(const weft_target *target, double place_mm[2])
{
    scaled_place(target, pin_place, place_mm);
}

weft_rectangle weft_target_marker(const weft_target *target, int id)
{
    double side = id < WEFT_TARGET_MARKER_COUNT ? marker_side : outer_marker_side;
    return centred_rectangle(target, marker_center[id], side, side);
}

weft_rectangle weft_target_reference(const weft_target *target, int index)
{
    bool beside = index % 2 == 0; /* beside the opening: long side along y */
    return centred_rectangle(target, reference_center[index], beside ? reference_across : reference_along,
                             beside ? reference_along : reference_across);
}

static bool contains(weft_rectangle r, double x, double y)
{
    return x >= r.x0 && x < r.x1 && y >= r.y0 && y < r.y1;
}

weft_target_region weft_target_region_at(const weft_target *target, double x_mm, double y_mm)
{
    double half = target->opening_mm / 2, radius = weft_target_radius_mm(target);
    if (fabs(x_mm) < half && fabs(y_mm) < half)
        return WEFT_TARGET_OPENING;
    if (x_mm * x_mm + y_mm * y_mm > radius * radius)
        return WEFT_TARGET_OUTSIDE;
    for (int index = 0; index < WEFT_TARGET_REFERENCE_COUNT; index++) {
        if (contains(weft_target_reference(target, index), x_mm, y_mm))
            return WEFT_TARGET_REFERENCE;
    }
    return WEFT_TARGET_PRINT;
}

/* Whether the cell of a marker under a point inside its outline is ink; the outermost cells always are. */
static bool marker_inked(int id, weft_rectangle outline, double x, double y)
{
    int column = (int)((x - outline.x0) / (outline.x1 - outline.x0) * 6);
    int row = (int)((outline.y1 - y) / (outline.y1 - outline.y0) * 6);
    if (column < 1 || column > 4 || row < 1 || row > 4)
        return true;
    return !(marker_cells[id] >> (15 - (4 * (row - 1) + column - 1)) & 1);
}

/* Of markers [first, end) and the paper round them. */
static double print_reflectance(const weft_target *target, int first, int end, double x, double y)
{
    for (int id = first; id < end; id++) {
        weft_rectangle outline = weft_target_marker(target, id);
        if (contains(outline, x, y))
            return marker_inked(id, outline, x, y) ? target->ink_reflectance : target->paper_reflectance;
    }
    return target->paper_reflectance;
}

double weft_target_reflectance(const weft_target *target, double x_mm, double y_mm)
{
    switch (weft_target_region_at(target, x_mm, y_mm)) {
    case WEFT_TARGET_PRINT:
        return print_reflectance(target, 0, WEFT_TARGET_MARKER_COUNT, x_mm, y_mm);
    case WEFT_TARGET_REFERENCE:
        return target->white_reflectance;
    case WEFT_TARGET_OPENING:
    case WEFT_TARGET_OUTSIDE:
        break;
    }
    return 0;
}

double weft_target_sheet_reflectance(const weft_target *target, double x_mm, double y_mm)
{
    if (weft_target_region_at(target, x_mm, y_mm) != WEFT_TARGET_OUTSIDE)
        return weft_target_reflectance(target, x_mm, y_mm);
    return print_reflectance(target, WEFT_TARGET_MARKER_COUNT, WEFT_SHEET_MARKER_COUNT, x_mm, y_mm);
}
