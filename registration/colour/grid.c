#include "registration/colour/patches.h"

#include "base/numeric/statistics.h"
#include "registration/pose/opencv_bridge.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CELLS = 140, FEWEST_AREAS = 8, ROUNDS = 3, SEED_REACH = 2 };

/* Levels by which an area may differ from the colour in its middle. */
static const int even = 14;

/* Bounds of the area of a patch, of its cell; reach of the search, in sides; and how far the middle of an area may lie
 * from the middle of its cell, in cells. */
static const double least_area = 0.3, largest_area = 0.97, reach = 0.75, astray = 0.1;

void weft_chart_grid_see(const weft_chart_grid *grid, double column, double row, double pixel[2])
{
    const double(*m)[3] = grid->to_pixel;
    double w = m[2][0] * column + m[2][1] * row + m[2][2];
    pixel[0] = (m[0][0] * column + m[0][1] * row + m[0][2]) / w;
    pixel[1] = (m[1][0] * column + m[1][1] * row + m[1][2]) / w;
}

double weft_chart_grid_side(const weft_chart_grid *grid, double column, double row)
{
    double here[2], right[2], below[2];
    weft_chart_grid_see(grid, column, row, here);
    weft_chart_grid_see(grid, column + 0.5, row, right);
    weft_chart_grid_see(grid, column, row + 0.5, below);
    return 2 * fmin(hypot(right[0] - here[0], right[1] - here[1]), hypot(below[0] - here[0], below[1] - here[1]));
}

weft_code weft_chart_grid_of_corners(weft_chart_layout layout, const weft_chart_sighting *sighting,
                                     weft_chart_grid *grid, weft_error *error)
{
    const double plane[4][2] = {{0, 0}, {layout.columns, 0}, {layout.columns, layout.rows}, {0, layout.rows}};
    uint8_t agrees[4];
    grid->layout = layout;
    return weft_opencv_fit_homography(plane, (const double(*)[2])sighting->corner, 4, 1, grid->to_pixel, agrees, error);
}

/* ---- An area of even colour ---- */

typedef struct window {
    const uint8_t *rgb;
    int width, x0, y0, across, down; /* of the picture, and of the window in it */
    uint8_t *state;                  /* [down][across] 1: in the area */
    int *queue;
} window;

static const uint8_t *colour_at(const window *w, int place)
{
    return w->rgb + 3 * ((long)(w->y0 + place / w->across) * w->width + w->x0 + place % w->across);
}

static void seed_colour(const window *w, int place, uint8_t seed[3])
{
    for (int c = 0; c < 3; c++) {
        double value[(2 * SEED_REACH + 1) * (2 * SEED_REACH + 1)];
        int count = 0;
        for (int dy = -SEED_REACH; dy <= SEED_REACH; dy++)
            for (int dx = -SEED_REACH; dx <= SEED_REACH; dx++)
                value[count++] = colour_at(w, place + dy * w->across + dx)[c];
        seed[c] = (uint8_t)weft_quantile(value, (size_t)count, 0.5);
    }
}

static bool is_like(const uint8_t *colour, const uint8_t seed[3])
{
    return abs(colour[0] - seed[0]) <= even && abs(colour[1] - seed[1]) <= even && abs(colour[2] - seed[2]) <= even;
}

/* Grows from the middle of the window. The pixels of the area; 0 where it reaches the border. */
static int grow(window *w, double middle[2])
{
    int start = w->down / 2 * w->across + w->across / 2, count = 0, done = 0;
    uint8_t seed[3];
    double sum[2] = {0, 0};
    seed_colour(w, start, seed);
    memset(w->state, 0, (size_t)w->across * (size_t)w->down);
    w->queue[count++] = start;
    w->state[start] = 1;
    while (done < count) {
        int place = w->queue[done++], x = place % w->across, y = place / w->across;
        const int next[4] = {place - 1, place + 1, place - w->across, place + w->across};
        if (x == 0 || y == 0 || x == w->across - 1 || y == w->down - 1)
            return 0;
        sum[0] += x;
        sum[1] += y;
        for (int i = 0; i < 4; i++) {
            if (!w->state[next[i]] && is_like(colour_at(w, next[i]), seed)) {
                w->state[next[i]] = 1;
                w->queue[count++] = next[i];
            }
        }
    }
    middle[0] = w->x0 + sum[0] / count;
    middle[1] = w->y0 + sum[1] / count;
    return count;
}

/* Whether the cell shows an area of a patch's size, and its middle. */
static bool find_area(window *w, int height, double side, const double centre[2], double middle[2])
{
    int half = (int)(reach * side);
    int x = (int)lround(centre[0]), y = (int)lround(centre[1]);
    if (half < 2 * SEED_REACH || x - half < 0 || y - half < 0 || x + half >= w->width || y + half >= height)
        return false;
    w->x0 = x - half;
    w->y0 = y - half;
    w->across = w->down = 2 * half + 1;
    double area = grow(w, middle) / (side * side);
    return area > least_area && area < largest_area;
}

/* ---- The grid ---- */

static bool window_create(const uint8_t *rgb, int width, int height, window *w)
{
    size_t most = (size_t)width * (size_t)height;
    *w = (window){.rgb = rgb, .width = width, .state = malloc(most), .queue = malloc(most * sizeof *w->queue)};
    return w->state && w->queue;
}

static int find_areas(window *w, int height, const weft_chart_grid *grid, double (*cell)[2], double (*middle)[2])
{
    int count = 0;
    for (int i = 0; i < grid->layout.columns * grid->layout.rows; i++) {
        double column = i % grid->layout.columns + 0.5, row = i / grid->layout.columns + 0.5, centre[2];
        weft_chart_grid_see(grid, column, row, centre);
        if (!find_area(w, height, weft_chart_grid_side(grid, column, row), centre, middle[count]))
            continue;
        cell[count][0] = column;
        cell[count++][1] = row;
    }
    return count;
}

static weft_code lay_through_areas(window *w, int height, weft_chart_grid *grid, int *seen, weft_error *error)
{
    double cell[MOST_CELLS][2], middle[MOST_CELLS][2];
    uint8_t agrees[MOST_CELLS] = {0};
    int count = find_areas(w, height, grid, cell, middle);
    double side = weft_chart_grid_side(grid, grid->layout.columns / 2.0, grid->layout.rows / 2.0);
    *seen = 0;
    if (count < FEWEST_AREAS)
        return WEFT_OK;
    weft_code code = weft_opencv_fit_homography((const double(*)[2])cell, (const double(*)[2])middle, count,
                                                astray * side, grid->to_pixel, agrees, error);
    for (int i = 0; code == WEFT_OK && i < count; i++)
        *seen += agrees[i];
    return code == WEFT_BAD_INPUT ? WEFT_OK : code;
}

weft_code weft_chart_grid_refine(const uint8_t *rgb, int width, int height, weft_chart_grid *grid, int *seen,
                                 weft_error *error)
{
    window w;
    weft_code code = window_create(rgb, width, height, &w)
                         ? WEFT_OK
                         : weft_fail_memory(error, "chart", (unsigned long long)width * (unsigned long long)height * 5);
    *seen = FEWEST_AREAS;
    for (int round = 0; code == WEFT_OK && *seen >= FEWEST_AREAS && round < ROUNDS; round++)
        code = lay_through_areas(&w, height, grid, seen, error);
    free(w.state);
    free(w.queue);
    return code;
}
