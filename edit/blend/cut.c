#include "edit/blend/steps.h"

#include "base/numeric/statistics.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Sizes are tried on pictures of about so many columns; the best is then refined texel by texel. */
enum { SEARCH_SIDE = 96 };

/* A longer material may be joined worse by this factor, and by this much of the difference of neighbours. */
static const double longer_is_worth = 1.25, faint = 0.02;

/* Ends between which there is a stronger break than between this share of neighbouring columns do not meet. */
static const double breaks_strongly = 0.95;

/* ---- Paths ---- */

/* best[row][column]: cost of the cheapest path from row 0 that ends there; from column `start` alone unless it is -1.
 */
static void sum_paths(const float *cost, int rows, int columns, int low, int high, int start, double *best)
{
    for (int y = 0; y < rows; y++)
        for (int x = low; x <= high; x++) {
            double before = y == 0 && (start < 0 || start == x) ? 0 : DBL_MAX;
            for (int from = x - 1; y > 0 && from <= x + 1; from++)
                if (from >= low && from <= high)
                    before = fmin(before, best[(size_t)(y - 1) * (size_t)columns + (size_t)from]);
            best[(size_t)y * (size_t)columns + (size_t)x] =
                before < DBL_MAX ? before + cost[(size_t)y * (size_t)columns + (size_t)x] : DBL_MAX;
        }
}

/* The cheapest end among columns low .. high of the last row, and the way back from there. */
static double trace_back(const double *best, int rows, int columns, int low, int high, int least_end, int most_end,
                         int *at)
{
    const double *last = best + (size_t)(rows - 1) * (size_t)columns;
    int x = least_end;
    for (int end = least_end; end <= most_end; end++)
        x = last[end] < last[x] ? end : x;
    double total = last[x];
    for (int y = rows - 1; y >= 0; y--) {
        at[y] = x;
        const double *above = y > 0 ? best + (size_t)(y - 1) * (size_t)columns : NULL;
        int next = x;
        for (int from = x - 1; above && from <= x + 1; from++)
            if (from >= low && from <= high && above[from] < above[next])
                next = from;
        x = next;
    }
    return total;
}

static void find_closed(const float *cost, int rows, int columns, int low, int high, double *best, int *trial, int *at,
                        double *total)
{
    for (int start = low; start <= high; start++) {
        sum_paths(cost, rows, columns, low, high, start, best);
        int least = start > low ? start - 1 : low, most = start < high ? start + 1 : high;
        double sum = trace_back(best, rows, columns, low, high, least, most, trial);
        if (sum < *total) {
            *total = sum;
            memcpy(at, trial, (size_t)rows * sizeof *at);
        }
    }
}

weft_code weft_cheapest_path(const float *cost, int rows, int columns, int low, int high, bool closed, int *at,
                             double *total, weft_error *error)
{
    size_t cells = (size_t)rows * (size_t)columns;
    double *best = calloc(cells, sizeof *best);
    int *trial = calloc((size_t)rows, sizeof *trial);
    if (!best || !trial) {
        free(best);
        free(trial);
        return weft_fail_memory(error, "the cut", cells * sizeof *best);
    }
    *total = DBL_MAX;
    if (closed)
        find_closed(cost, rows, columns, low, high, best, trial, at, total);
    else {
        sum_paths(cost, rows, columns, low, high, -1, best);
        *total = trace_back(best, rows, columns, low, high, low, high, at);
    }
    free(best);
    free(trial);
    return WEFT_OK;
}

/* ---- Sizes ---- */

static double neighbour_difference(const weft_blend_pictures *pictures)
{
    double sum = 0;
    for (int y = 0; y < pictures->height; y++)
        for (int x = 0; x + 1 < pictures->width; x++)
            sum += weft_blend_difference(pictures, x, y, pictures, x + 1, y);
    return sum / ((double)pictures->height * (pictures->width - 1));
}

/* What the ends differ by where they overlap, squared so that one strong edge costs more than many faint ones: cost
 * [height][overlap]. */
static void find_costs(const weft_blend_pictures *pictures, int size, int overlap, float *cost)
{
#pragma omp parallel for if (pictures->height > 64)
    for (int y = 0; y < pictures->height; y++)
        for (int x = 0; x < overlap; x++) {
            float difference = weft_blend_difference(pictures, x, y, pictures, x + size, y);
            cost[(size_t)y * (size_t)overlap + (size_t)x] = difference * difference;
        }
}

static weft_code try_size(const weft_blend_pictures *pictures, int size, bool closed, double scale, weft_cut *cut,
                          weft_error *error)
{
    int overlap = pictures->width - size;
    float *cost = malloc((size_t)pictures->height * (size_t)overlap * sizeof *cost);
    *cut = (weft_cut){size, overlap, malloc((size_t)pictures->height * sizeof *cut->at), 0};
    weft_code code = WEFT_OK;
    if (!cost || !cut->at)
        code = weft_fail_memory(error, "the cut", (size_t)pictures->height * (size_t)overlap * sizeof *cost);
    if (code == WEFT_OK) {
        find_costs(pictures, size, overlap, cost);
        code = weft_cheapest_path(cost, pictures->height, overlap, WEFT_CUT_MARGIN, overlap - WEFT_CUT_MARGIN, closed,
                                  cut->at, &cut->cost, error);
        cut->cost = sqrt(cut->cost / pictures->height) / fmax(scale, FLT_MIN);
    }
    free(cost);
    if (code != WEFT_OK)
        weft_cut_free(cut);
    return code;
}

/* The longest of the sizes first .. last that is joined well, or almost as well as the best of them. */
static weft_code choose_size(const weft_blend_pictures *pictures, int first, int last, bool closed, int *chosen,
                             weft_error *error)
{
    double scale = neighbour_difference(pictures), best = DBL_MAX;
    double *cost = malloc((size_t)(last - first + 1) * sizeof *cost);
    if (!cost)
        return weft_fail_memory(error, "the cut", (size_t)(last - first + 1) * sizeof *cost);
    weft_code code = WEFT_OK;
    for (int size = first; size <= last && code == WEFT_OK; size++) {
        weft_cut cut;
        code = try_size(pictures, size, closed, scale, &cut, error);
        if (code != WEFT_OK)
            break;
        cost[size - first] = cut.cost;
        best = fmin(best, cut.cost);
        weft_cut_free(&cut);
    }
    for (int size = first; size <= last && code == WEFT_OK; size++)
        if (cost[size - first] <= longer_is_worth * best + faint)
            *chosen = size;
    free(cost);
    return code;
}

static int limited(int value, int low, int high)
{
    return value < low ? low : value > high ? high : value;
}

/* On smaller pictures; the answer is a size of the larger ones. */
static weft_code search_coarsely(const weft_blend_pictures *pictures, int side, bool closed, int *size,
                                 weft_error *error)
{
    weft_blend_pictures small;
    WEFT_TRY(weft_blend_pictures_reduce(pictures, side, &small, error));
    int most = small.width - WEFT_CUT_LEAST_OVERLAP;
    weft_code code = choose_size(&small, (small.width + 1) / 2, most, closed, size, error);
    weft_blend_pictures_free(&small);
    *size *= side;
    return code;
}

/* How far the step from column x to the next is from the mean of the steps before and after it, where columns go round:
 * squared, a mean over rows. Small where a pattern goes on, whatever its slope. */
static double column_break(const weft_blend_pictures *pictures, int x)
{
    double sum = 0;
    for (int y = 0; y < pictures->height; y++) {
        const float *at[4];
        for (int i = 0; i < 4; i++)
            at[i] = weft_blend_texel(pictures, (x + i - 1 + pictures->width) % pictures->width, y);
        for (int i = 0; i < WEFT_BLEND_VALUES; i++) {
            double apart = at[2][i] - at[1][i] - 0.5 * (at[3][i] - at[2][i] + at[1][i] - at[0][i]);
            sum += apart * apart;
        }
    }
    return sum;
}

/* Whether the last column goes on in the first as columns do elsewhere. */
static weft_code find_whether_ends_meet(const weft_blend_pictures *pictures, bool *meet, weft_error *error)
{
    size_t count = (size_t)pictures->width - 3;
    double *inside = malloc(count * sizeof *inside);
    if (!inside)
        return weft_fail_memory(error, "the cut", count * sizeof *inside);
    for (size_t x = 0; x < count; x++)
        inside[x] = column_break(pictures, (int)x + 1);
    *meet = column_break(pictures, pictures->width - 1) <= 1.01 * weft_quantile(inside, count, breaks_strongly);
    free(inside);
    return WEFT_OK;
}

static weft_code leave_whole(const weft_blend_pictures *pictures, weft_cut *cut, weft_error *error)
{
    *cut = (weft_cut){.size = pictures->width, .at = calloc((size_t)pictures->height, sizeof *cut->at)};
    return cut->at ? WEFT_OK : weft_fail_memory(error, "the cut", (size_t)pictures->height * sizeof *cut->at);
}

static weft_code find_cut(const weft_blend_pictures *pictures, bool closed, weft_cut *cut, weft_error *error)
{
    int first = (pictures->width + 1) / 2, last = pictures->width - WEFT_CUT_LEAST_OVERLAP, size = last;
    int shorter = pictures->width < pictures->height ? pictures->width : pictures->height;
    int side = limited(pictures->width / SEARCH_SIDE, 1, shorter / WEFT_CUT_LEAST_SIDE);
    if (side > 1) {
        WEFT_TRY(search_coarsely(pictures, side, closed, &size, error));
        first = limited(size - side, first, last);
        last = limited(size + side, first, last);
    }
    WEFT_TRY(choose_size(pictures, first, last, closed, &size, error));
    return try_size(pictures, size, closed, neighbour_difference(pictures), cut, error);
}

weft_code weft_cut_find(const weft_blend_pictures *pictures, bool closed, weft_cut *cut, weft_error *error)
{
    bool meet;
    WEFT_TRY(find_whether_ends_meet(pictures, &meet, error));
    return meet ? leave_whole(pictures, cut, error) : find_cut(pictures, closed, cut, error);
}

void weft_cut_free(weft_cut *cut)
{
    free(cut->at);
    *cut = (weft_cut){0};
}

float weft_cut_share(const weft_cut *cut, int x, int y)
{
    if (x >= cut->overlap)
        return 0;
    float share = 0.5f + ((float)(cut->at[y] - x) - 0.5f) / 3;
    return share < 0 ? 0 : share > 1 ? 1 : share;
}

weft_code weft_cut_apply(const weft_blend_pictures *pictures, const weft_cut *cut, weft_blend_pictures *result,
                         weft_error *error)
{
    WEFT_TRY(weft_blend_pictures_create(cut->size, pictures->height, result, error));
    for (int y = 0; y < result->height; y++)
        for (int x = 0; x < result->width; x++) {
            int from = weft_cut_share(cut, x, y) > 0.5f ? x + cut->size : x;
            memcpy(weft_blend_texel(result, x, y), weft_blend_texel(pictures, from, y),
                   WEFT_BLEND_VALUES * sizeof(float));
        }
    return WEFT_OK;
}
