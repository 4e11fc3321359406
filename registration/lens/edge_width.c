#include "registration/lens/board_points.h"

#include <math.h>
#include <stdlib.h>

enum { REACH = 10, DIRECTIONS = 4 };

static const int direction[DIRECTIONS][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}};

static int grey_range(const uint8_t *grey, int width, int x0, int y0)
{
    int low = 255, high = 0;
    for (int y = y0 - REACH; y <= y0 + REACH; y++) {
        for (int x = x0 - REACH; x <= x0 + REACH; x++) {
            int value = grey[(long)y * width + x];
            low = value < low ? value : low;
            high = value > high ? value : high;
        }
    }
    return high - low;
}

/* Grey values a pixel. */
static double steepest_slope(const uint8_t *grey, int width, int x0, int y0, const int d[2])
{
    int most = 0;
    long step = (long)d[1] * width + d[0];
    for (int y = y0 - REACH; y <= y0 + REACH; y++) {
        for (int x = x0 - REACH; x <= x0 + REACH; x++) {
            const uint8_t *at = grey + (long)y * width + x;
            int difference = abs(at[step] - at[-step]);
            most = difference > most ? difference : most;
        }
    }
    return most / (2 * hypot(d[0], d[1]));
}

/* 0 too near the border, or where there is no edge. */
static double width_at(const uint8_t *grey, int width, int height, const double pixel[2])
{
    int x = (int)lround(pixel[0]), y = (int)lround(pixel[1]);
    if (x <= REACH || y <= REACH || x >= width - REACH - 1 || y >= height - REACH - 1)
        return 0;
    double least = INFINITY;
    for (int i = 0; i < DIRECTIONS; i++)
        least = fmin(least, steepest_slope(grey, width, x, y, direction[i]));
    return least > 0 ? grey_range(grey, width, x, y) / least : 0;
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double weft_board_edge_width(const uint8_t *grey, int width, int height, const weft_board_point *point, int count)
{
    enum { MOST = 256 };
    double widths[MOST];
    int known = 0, stride = count / MOST + 1;
    for (int i = 0; i < count && known < MOST; i += stride) {
        widths[known] = width_at(grey, width, height, point[i].pixel);
        known += widths[known] > 0;
    }
    qsort(widths, (size_t)known, sizeof *widths, ascending);
    return known > 0 ? widths[known / 2] : 0;
}
