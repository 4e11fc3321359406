#include "btf/direction/smooth_map.h"

#include "base/real.h"

#include <lapacke.h>
#include <stdlib.h>
#include <string.h>

enum { LEAST_SIDE = 4, MOST_SIDE = 64, STENCIL = 4 };

/* Keeps the matrix positive definite where the samples leave a plane undecided: it then lies as low as it can. */
static const double ridge = 1e-9;

/* N = sum of w_i B_i' B_i over places and zeros, plus the curvature, as its lower band: element (row, column) of the
 * lower triangle stands at column * (width + 1) + row - column. Rows of the square are `side` nodes apart and the
 * curvature reaches over two. */
struct weft_smooth_map {
    int side, node_count, width, count;
    double *band;           /* [node_count][width + 1] Cholesky's factor */
    weft_square_cell *cell; /* [count] */
    double *weight;         /* [count] */
};

void weft_smooth_map_free(weft_smooth_map *map)
{
    if (!map)
        return;
    free(map->band);
    free(map->cell);
    free(map->weight);
    free(map);
}

/* Adds weight (w' f)^2 to the quadratic form, for weights w of the nodes index [count]. */
static void add_square(weft_smooth_map *map, const int *index, const double *w, int count, double weight)
{
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) {
            if (index[i] >= index[j])
                map->band[index[j] * (map->width + 1) + index[i] - index[j]] += weight * w[i] * w[j];
        }
}

static void add_place(weft_smooth_map *map, const weft_square_cell *cell, double weight)
{
    double corner[STENCIL];
    for (int i = 0; i < STENCIL; i++)
        corner[i] = (double)cell->weight[i];
    add_square(map, cell->index, corner, STENCIL, weight);
}

static void add_curvature(weft_smooth_map *map, double smoothness)
{
    static const double second[] = {1, -2, 1}, mixed[] = {1, -1, -1, 1};
    int side = map->side;
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            int at = y * side + x;
            if (x > 0 && x + 1 < side)
                add_square(map, (int[]){at - 1, at, at + 1}, second, 3, smoothness);
            if (y > 0 && y + 1 < side)
                add_square(map, (int[]){at - side, at, at + side}, second, 3, smoothness);
            if (x + 1 < side && y + 1 < side)
                add_square(map, (int[]){at, at + 1, at + side, at + side + 1}, mixed, 4, 2 * smoothness);
        }
}

static void assemble(weft_smooth_map *map, const weft_smooth_map_places *places)
{
    for (int i = 0; i < places->count; i++) {
        map->cell[i] = weft_square_cell_at(places->place[i], map->side);
        map->weight[i] = places->weight ? (double)places->weight[i] : 1;
        add_place(map, &map->cell[i], map->weight[i]);
    }
    for (int i = 0; i < places->zero_count; i++) {
        weft_square_cell cell = weft_square_cell_at(places->zero[i], map->side);
        add_place(map, &cell, 1);
    }
    add_curvature(map, places->smoothness);
    for (int i = 0; i < map->node_count; i++)
        map->band[i * (map->width + 1)] += ridge;
}

static weft_code allocate(const weft_smooth_map_places *places, weft_smooth_map *map, weft_error *error)
{
    map->side = places->side;
    map->node_count = places->side * places->side;
    map->width = 2 * places->side;
    map->count = places->count;
    size_t band = (size_t)map->node_count * (size_t)(map->width + 1);
    map->band = calloc(band, sizeof *map->band);
    map->cell = calloc((size_t)places->count + 1, sizeof *map->cell);
    map->weight = calloc((size_t)places->count + 1, sizeof *map->weight);
    return map->band && map->cell && map->weight ? WEFT_OK
                                                 : weft_fail_memory(error, "smooth map", band * sizeof *map->band);
}

weft_code weft_smooth_map_create(const weft_smooth_map_places *places, weft_smooth_map **result, weft_error *error)
{
    if (places->side < LEAST_SIDE || places->side > MOST_SIDE || !(places->smoothness > 0))
        return weft_fail(error, WEFT_BAD_USAGE, "a smooth map cannot have %d nodes a side and smoothness %g",
                         places->side, places->smoothness);
    weft_smooth_map *map = calloc(1, sizeof *map);
    if (!map)
        return weft_fail_memory(error, "smooth map", sizeof *map);
    weft_code code = allocate(places, map, error);
    if (code == WEFT_OK) {
        assemble(map, places);
        if (LAPACKE_dpbtrf_work(LAPACK_COL_MAJOR, 'L', map->node_count, map->width, map->band, map->width + 1) != 0)
            code = weft_fail(error, WEFT_BAD_INPUT, "a smooth map needs finite directions");
    }
    if (code != WEFT_OK)
        weft_smooth_map_free(map);
    else
        *result = map;
    return code;
}

/* Sets of values that are solved for at once: LAPACK's dpbtrs takes one after another, and reads the band anew for
 * each. As many as a vector register of AVX2 holds: longer vectors are kept in memory by the compiler, at a third of
 * the speed. */
enum { TOGETHER = 4 };

typedef double together __attribute__((vector_size(TOGETHER * sizeof(double)), aligned(sizeof(double))));

/* The number of columns is a constant where these are called: their loops are unrolled. */
#define ALWAYS_INLINE static inline __attribute__((always_inline))

/* right = B' w y for the sets from `first` on. */
static void spread(const weft_smooth_map *map, const float *value, int first, int series_count, together *right)
{
    int sets = series_count - first < TOGETHER ? series_count - first : TOGETHER;
    memset(right, 0, (size_t)map->node_count * sizeof *right);
    for (int i = 0; i < map->count; i++)
        for (int corner = 0; corner < STENCIL; corner++) {
            const float *of = value + (size_t)i * (size_t)series_count + first;
            double weight = map->weight[i] * (double)map->cell[i].weight[corner];
            for (int set = 0; set < sets; set++)
                right[map->cell[i].index[corner]][set] += weight * (double)of[set];
        }
}

/* Columns that are solved for together, so that a row is read and written once for all of them. */
enum { BLOCK = 4 };

/* Element (row, column) of L, within the band. */
static inline double element(const double *band, int width, int row, int column)
{
    return band[column * width + row];
}

/* The first row that the band of a column does not reach. */
static inline int row_beyond(int node_count, int width, int column)
{
    return column + width + 1 < node_count ? column + width + 1 : node_count;
}

/* Solves L x = right for `count` columns from `first` on, and takes them out of the rows below. */
ALWAYS_INLINE void forward(const double *band, int node_count, int width, together *right, int first, int count)
{
    together x[BLOCK];
#pragma GCC unroll 4
    for (int k = 0; k < count; k++) {
        x[k] = right[first + k];
#pragma GCC unroll 4
        for (int j = 0; j < k; j++)
            x[k] -= element(band, width, first + k, first + j) * x[j];
        x[k] /= element(band, width, first + k, first + k);
        right[first + k] = x[k];
    }
    int end_of_first = row_beyond(node_count, width, first), end = row_beyond(node_count, width, first + count - 1);
    for (int row = first + count; row < end_of_first; row++) {
        together rest = right[row];
#pragma GCC unroll 4
        for (int k = 0; k < count; k++)
            rest -= element(band, width, row, first + k) * x[k];
        right[row] = rest;
    }
    for (int row = end_of_first; row < end; row++)
        for (int k = row - width - first; k < count; k++)
            right[row] -= element(band, width, row, first + k) * x[k];
}

/* Solves L' x = right for `count` columns from `first` on, where the rows below are solved. */
ALWAYS_INLINE void backward(const double *band, int node_count, int width, together *right, int first, int count)
{
    together x[BLOCK];
#pragma GCC unroll 4
    for (int k = 0; k < count; k++)
        x[k] = right[first + k];
    int end_of_first = row_beyond(node_count, width, first), end = row_beyond(node_count, width, first + count - 1);
    for (int row = first + count; row < end_of_first; row++) {
#pragma GCC unroll 4
        for (int k = 0; k < count; k++)
            x[k] -= element(band, width, row, first + k) * right[row];
    }
    for (int row = end_of_first; row < end; row++)
        for (int k = row - width - first; k < count; k++)
            x[k] -= element(band, width, row, first + k) * right[row];
#pragma GCC unroll 4
    for (int k = count - 1; k >= 0; k--) {
#pragma GCC unroll 4
        for (int j = k + 1; j < count; j++)
            x[k] -= element(band, width, first + j, first + k) * x[j];
        x[k] /= element(band, width, first + k, first + k);
        right[first + k] = x[k];
    }
}

/* L L' f = right, in place: forward, then backward substitution. */
WEFT_HOT static void substitute(const double *band, int node_count, int width, together *right)
{
    int whole = node_count / BLOCK * BLOCK;
    for (int first = 0; first < whole; first += BLOCK)
        forward(band, node_count, width, right, first, BLOCK);
    for (int column = whole; column < node_count; column++)
        forward(band, node_count, width, right, column, 1);
    for (int column = node_count - 1; column >= whole; column--)
        backward(band, node_count, width, right, column, 1);
    for (int first = whole - BLOCK; first >= 0; first -= BLOCK)
        backward(band, node_count, width, right, first, BLOCK);
}

static void keep(const weft_smooth_map *map, together *solved, int first, int series_count, float *node)
{
    for (int i = 0; i < map->node_count; i++)
        for (int set = 0; set < TOGETHER && first + set < series_count; set++)
            node[(size_t)i * (size_t)series_count + (size_t)(first + set)] = (float)solved[i][set];
}

weft_code weft_smooth_map_solve(const weft_smooth_map *map, const float *value, int series_count, float *node,
                                weft_error *error)
{
    together *right = malloc((size_t)map->node_count * sizeof *right);
    if (!right)
        return weft_fail_memory(error, "smooth map", (size_t)map->node_count * sizeof *right);
    for (int first = 0; first < series_count; first += TOGETHER) {
        spread(map, value, first, series_count, right);
        substitute(map->band, map->node_count, map->width, right);
        keep(map, right, first, series_count, node);
    }
    free(right);
    return WEFT_OK;
}

/* The inverse Z of N within its band, both sides of it: element (row, column) stands at
 * row * (2 width + 1) + width + column - row, so that a row lies in one piece. */
static double *inverse_row(const weft_smooth_map *map, double *inverse, int row)
{
    return inverse + (size_t)row * (size_t)(2 * map->width + 1) + map->width - row;
}

/* A column of Z, and with it a row, from those that follow: of L' Z = L^-1, whose upper triangle is 0 but for the
 * diagonal (Takahashi, Fagan and Chin 1973). */
static void invert_column(const weft_smooth_map *map, int column, double *inverse)
{
    double below[2 * MOST_SIDE] = {0};
    int count = column + map->width < map->node_count ? map->width : map->node_count - 1 - column, next = column + 1;
    const double *factor = map->band + (size_t)column * (size_t)(map->width + 1);
    double *own = inverse_row(map, inverse, column), sum = 1 / factor[0];
    for (int k = 0; k < count; k++) {
        const double *row = inverse_row(map, inverse, next + k) + next;
        for (int i = 0; i < count; i++)
            below[i] -= factor[k + 1] * row[i];
    }
    for (int i = 0; i < count; i++)
        own[next + i] = inverse_row(map, inverse, next + i)[column] = below[i] / factor[0];
    for (int k = 0; k < count; k++)
        sum -= factor[k + 1] * own[next + k];
    own[column] = sum / factor[0];
}

weft_code weft_smooth_map_variances(const weft_smooth_map *map, float *variance, weft_error *error)
{
    size_t count = (size_t)map->node_count * (size_t)(2 * map->width + 1);
    double *inverse = malloc(count * sizeof *inverse);
    if (!inverse)
        return weft_fail_memory(error, "smooth map", count * sizeof *inverse);
    for (int column = map->node_count - 1; column >= 0; column--) {
        invert_column(map, column, inverse);
        variance[column] = (float)inverse_row(map, inverse, column)[column];
    }
    free(inverse);
    return WEFT_OK;
}
