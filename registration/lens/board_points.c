#include "registration/lens/board.h"

#include "btf/session/target.h"
#include "registration/pose/opencv_bridge.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MARKER_LIMIT = 1024, LAYOUTS = 2, LARGEST_REACH = 11, SMALLEST_REACH = 2 };

typedef struct picture {
    const uint8_t *grey;
    int width, height;
} picture;

/* Markers that were found, and where they are on the board. */
typedef struct placed_markers {
    int count;
    double board_mm[4 * MARKER_LIMIT][2], pixel[4 * MARKER_LIMIT][2]; /* of their corners, four each */
} placed_markers;

static double distance(const double a[2], const double b[2])
{
    return hypot(a[0] - b[0], a[1] - b[1]);
}

static int reach_for(double pixels)
{
    return (int)fmax(SMALLEST_REACH, fmin(LARGEST_REACH, pixels));
}

/* ---- Chessboard ---- */

static double smallest_spacing(const double (*corner)[2], int columns, int rows)
{
    double least = INFINITY;
    for (int i = 0; i < columns * rows; i++) {
        if (i % columns > 0)
            least = fmin(least, distance(corner[i], corner[i - 1]));
        if (i >= columns)
            least = fmin(least, distance(corner[i], corner[i - columns]));
    }
    return least;
}

static weft_code find_chessboard(const weft_board *b, const picture *p, weft_board_point *point, int *count,
                                 weft_error *error)
{
    int limit = b->columns * b->rows;
    bool found;
    double(*corner)[2] = calloc((size_t)limit, sizeof *corner);
    if (!corner)
        return weft_fail_memory(error, "corners", (size_t)limit * sizeof *corner);
    weft_code code =
        weft_opencv_find_chessboard(p->grey, p->width, p->height, b->columns, b->rows, corner, &found, error);
    if (code == WEFT_OK && found) {
        int reach = reach_for(0.4 * smallest_spacing((const double(*)[2])corner, b->columns, b->rows));
        code = weft_opencv_refine_corners(p->grey, p->width, p->height, corner, limit, reach, error);
    }
    if (code == WEFT_OK && found) {
        *count = limit;
        for (int i = 0; i < limit; i++)
            point[i] = (weft_board_point){{i % b->columns * b->size_mm, i / b->columns * b->size_mm},
                                          {corner[i][0], corner[i][1]}};
    }
    free(corner);
    return code;
}

/* ---- Markers ---- */

/* The outline of a marker of a grid: y down the board. */
static weft_rectangle outline_in_grid(const weft_board *b, int id)
{
    double pitch = b->size_mm + b->second_mm, x = id % b->columns * pitch, y = id / b->columns * pitch;
    return (weft_rectangle){x, y, x + b->size_mm, y + b->size_mm};
}

/* Of a marker of a ChArUco board, counted in rows from the top. The top left square is black in layout 0. Boards with
 * an even number of rows out of OpenCV before 4.6 have a marker there: layout 1. */
static weft_rectangle outline_in_chessboard(const weft_board *b, int layout, int id)
{
    int row = 0, first = layout == 0;
    for (; id >= (b->columns + 1 - first) / 2; row++, first = !first)
        id -= (b->columns + 1 - first) / 2;
    double edge = (b->size_mm - b->second_mm) / 2;
    double x = (first + 2 * id) * b->size_mm + edge, y = row * b->size_mm + edge;
    return (weft_rectangle){x, y, x + b->second_mm, y + b->second_mm};
}

static int marker_count(const weft_board *b, int layout)
{
    int cells = b->columns * b->rows;
    if (b->kind == WEFT_BOARD_PLATE)
        return WEFT_SHEET_MARKER_COUNT;
    return b->kind == WEFT_BOARD_CHARUCO ? (cells + layout) / 2 : cells;
}

/* y1 is the top. */
static weft_rectangle outline_of(const weft_board *b, int layout, int id)
{
    if (b->kind == WEFT_BOARD_PLATE) {
        weft_target target = weft_target_printed(b->size_mm);
        return weft_target_marker(&target, id);
    }
    weft_rectangle r = b->kind == WEFT_BOARD_CHARUCO ? outline_in_chessboard(b, layout, id) : outline_in_grid(b, id);
    return (weft_rectangle){r.x0, r.y1, r.x1, r.y0}; /* y down the board */
}

static bool is_first_of_its_id(const weft_marker *marker, int index)
{
    for (int i = 0; i < index; i++)
        if (marker[i].id == marker[index].id)
            return false;
    return true;
}

static void place_markers(const weft_board *b, int layout, const weft_marker *marker, int count, placed_markers *placed)
{
    bool any = b->kind == WEFT_BOARD_MARKERS && b->columns * b->rows == 1;
    placed->count = 0;
    for (int i = 0; i < count && (!any || count == 1); i++) {
        int id = any ? 0 : marker[i].id, at = 4 * placed->count;
        if (id >= marker_count(b, layout) || !is_first_of_its_id(marker, i))
            continue;
        weft_rectangle r = outline_of(b, layout, id);
        const double outline[4][2] = {{r.x0, r.y1}, {r.x1, r.y1}, {r.x1, r.y0}, {r.x0, r.y0}};
        memcpy(placed->board_mm[at], outline, sizeof outline);
        memcpy(placed->pixel[at], marker[i].corner, sizeof marker[i].corner);
        placed->count++;
    }
}

static double smallest_side(const placed_markers *placed)
{
    double least = INFINITY;
    for (int i = 0; i < 4 * placed->count; i++)
        least = fmin(least, distance(placed->pixel[i], placed->pixel[i % 4 == 3 ? i - 3 : i + 1]));
    return least;
}

/* Drops markers that are not where the others say; a lens bends the board less than the reach. The homography takes mm
 * to pixels. */
static weft_code keep_those_that_agree(placed_markers *placed, double homography[3][3], weft_error *error)
{
    if (placed->count == 0)
        return WEFT_OK;
    uint8_t *agrees = calloc((size_t)placed->count, 4);
    if (!agrees)
        return weft_fail_memory(error, "markers", 4ull * (size_t)placed->count);
    double reach = fmax(3, 0.35 * smallest_side(placed));
    weft_code code = weft_opencv_fit_homography((const double(*)[2])placed->board_mm, (const double(*)[2])placed->pixel,
                                                4 * placed->count, reach, homography, agrees, error);
    int kept = 0;
    for (int i = 0; code == WEFT_OK && i < placed->count; i++) {
        if (!(agrees[4 * i] && agrees[4 * i + 1] && agrees[4 * i + 2] && agrees[4 * i + 3]))
            continue;
        memmove(placed->board_mm[4 * kept], placed->board_mm[4 * i], 4 * sizeof placed->board_mm[0]);
        memmove(placed->pixel[4 * kept], placed->pixel[4 * i], 4 * sizeof placed->pixel[0]);
        kept++;
    }
    placed->count = kept;
    free(agrees);
    return code == WEFT_BAD_INPUT ? WEFT_OK : code; /* no homography: none is left */
}

static void take_corners(const placed_markers *placed, weft_board_point *point, int *count)
{
    *count = 4 * placed->count;
    for (int i = 0; i < *count; i++) {
        memcpy(point[i].board_mm, placed->board_mm[i], sizeof point[i].board_mm);
        memcpy(point[i].pixel, placed->pixel[i], sizeof point[i].pixel);
    }
}

/* ---- Inner corners between markers ---- */

static void map(const double h[3][3], const double mm[2], double pixel[2])
{
    double w = h[2][0] * mm[0] + h[2][1] * mm[1] + h[2][2];
    for (int k = 0; k < 2; k++)
        pixel[k] = (h[k][0] * mm[0] + h[k][1] * mm[1] + h[k][2]) / w;
}

/* Where an inner corner is, by the homography and what the nearest corners of both markers that touch it say of its
 * error there. False where one of them was not found. `gap` is how far off they are, pixels. */
static bool predict(const weft_board *b, const placed_markers *placed, const double homography[3][3],
                    const double mm[2], double pixel[2], double *gap)
{
    double nearest = (b->size_mm - b->second_mm) * M_SQRT1_2, off[2] = {0, 0}, here[2];
    int touching = 0;
    *gap = INFINITY;
    map(homography, mm, pixel);
    for (int i = 0; i < 4 * placed->count; i++) {
        if (distance(placed->board_mm[i], mm) > 1.01 * nearest)
            continue;
        map(homography, placed->board_mm[i], here);
        for (int k = 0; k < 2; k++)
            off[k] += (placed->pixel[i][k] - here[k]) / 2;
        *gap = fmin(*gap, distance(here, pixel));
        touching++;
    }
    for (int k = 0; k < 2; k++)
        pixel[k] += off[k];
    return touching == 2;
}

static weft_code add_corner(const weft_board *b, const picture *p, const placed_markers *placed,
                            const double homography[3][3], const double mm[2], weft_board_point *point, int *count,
                            weft_error *error)
{
    double pixel[1][2], gap, start[2];
    if (!predict(b, placed, homography, mm, pixel[0], &gap) || !(gap > SMALLEST_REACH) || !(pixel[0][0] > 0) ||
        !(pixel[0][1] > 0) || !(pixel[0][0] < p->width - 1) || !(pixel[0][1] < p->height - 1))
        return WEFT_OK;
    int reach = reach_for(0.7 * gap);
    memcpy(start, pixel[0], sizeof start);
    WEFT_TRY(weft_opencv_refine_corners(p->grey, p->width, p->height, pixel, 1, reach, error));
    if (distance(start, pixel[0]) < reach)
        point[(*count)++] = (weft_board_point){{mm[0], mm[1]}, {pixel[0][0], pixel[0][1]}};
    return WEFT_OK;
}

static weft_code take_inner_corners(const weft_board *b, const picture *p, const placed_markers *placed,
                                    const double homography[3][3], weft_board_point *point, int *count,
                                    weft_error *error)
{
    for (int row = 1; row < b->rows; row++) {
        for (int column = 1; column < b->columns; column++) {
            const double mm[2] = {column * b->size_mm, row * b->size_mm};
            WEFT_TRY(add_corner(b, p, placed, homography, mm, point, count, error));
        }
    }
    return WEFT_OK;
}

/* ---- Both ---- */

/* Takes the layout that more markers agree with. */
static weft_code agree_on_layout(const weft_board *b, const weft_marker *marker, int count, placed_markers *placed,
                                 double homography[3][3], weft_error *error)
{
    bool has_two = b->kind == WEFT_BOARD_CHARUCO && b->rows % 2 == 0;
    int best = 0, most = -1;
    for (int layout = 0; layout < (has_two ? LAYOUTS : 1); layout++) {
        place_markers(b, layout, marker, count, placed);
        WEFT_TRY(keep_those_that_agree(placed, homography, error));
        if (placed->count > most) {
            most = placed->count;
            best = layout;
        }
    }
    place_markers(b, best, marker, count, placed);
    return keep_those_that_agree(placed, homography, error);
}

static weft_code find_by_markers(const weft_board *b, const picture *p, weft_marker *marker, placed_markers *placed,
                                 weft_board_point *point, int *count, weft_error *error)
{
    int found;
    double homography[3][3];
    WEFT_TRY(
        weft_opencv_find_markers(b->dictionary, p->grey, p->width, p->height, marker, MARKER_LIMIT, &found, error));
    WEFT_TRY(agree_on_layout(b, marker, found, placed, homography, error));
    if (placed->count == 0)
        return WEFT_OK;
    if (b->kind == WEFT_BOARD_CHARUCO)
        return take_inner_corners(b, p, placed, (const double(*)[3])homography, point, count, error);
    take_corners(placed, point, count);
    return WEFT_OK;
}

weft_code weft_board_find(const weft_board *board, const uint8_t *grey, int width, int height, weft_board_point *point,
                          int *count, weft_error *error)
{
    const picture p = {grey, width, height};
    *count = 0;
    if (board->kind == WEFT_BOARD_CHESSBOARD)
        return find_chessboard(board, &p, point, count, error);
    weft_marker *marker = malloc(MARKER_LIMIT * sizeof *marker);
    placed_markers *placed = malloc(sizeof *placed);
    weft_code code = marker && placed ? find_by_markers(board, &p, marker, placed, point, count, error)
                                      : weft_fail_memory(error, "markers", sizeof *placed);
    free(marker);
    free(placed);
    return code;
}
