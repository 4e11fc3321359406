#include "btf/direction/kriged_map.h"

#include "base/real.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct weft_kriged_map {
    weft_kriged_places places; /* without `place` and `noise` */
    weft_square_cell *cell;    /* [count] */
    double *root;              /* [count][count] Cholesky's factor of C + noise, columns one after the other */
    double *of_one;            /* [count] (C + noise)^-1 of ones */
    double sum_of_one;
};

/* ---- The covariances of the nodes ---- */

static weft_vec3 node_at(int side, bool of_half_vectors, int node)
{
    weft_place place = {(weft_real)(node % side) / (weft_real)(side - 1),
                        (weft_real)(int)(node / side) / (weft_real)(side - 1)};
    return of_half_vectors ? weft_half_vector_of_place(place) : weft_direction_of_place(place);
}

static void fill_covariances(const weft_vec3 *direction, float length, float trend, weft_kriged_grid *grid)
{
    size_t count = (size_t)grid->node_count;
#pragma omp parallel for schedule(dynamic, 16)
    for (size_t i = 0; i < count; i++)
        for (size_t j = i; j < count; j++) {
            double x = sqrt(3) * (double)weft_length(weft_subtract(direction[i], direction[j])) / (double)length;
            double c = (1 + x) * exp(-x) + (double)trend * (1 + (double)weft_dot(direction[i], direction[j]));
            grid->covariance[i * count + j] = grid->covariance[j * count + i] = c;
        }
}

weft_code weft_kriged_grid_create(int side, bool of_half_vectors, float length, float trend, weft_kriged_grid *grid,
                                  weft_error *error)
{
    size_t count = (size_t)side * (size_t)side;
    weft_vec3 *direction = malloc(count * sizeof *direction);
    *grid = (weft_kriged_grid){
        .side = side, .node_count = side * side, .covariance = malloc(count * count * sizeof *grid->covariance)};
    if (!direction || !grid->covariance) {
        free(direction);
        weft_kriged_grid_free(grid);
        return weft_fail_memory(error, "covariances of nodes", count * count * sizeof *grid->covariance);
    }
    for (int i = 0; i < grid->node_count; i++)
        direction[i] = node_at(side, of_half_vectors, i);
    fill_covariances(direction, length, trend, grid);
    free(direction);
    return WEFT_OK;
}

void weft_kriged_grid_free(weft_kriged_grid *grid)
{
    free(grid->covariance);
    *grid = (weft_kriged_grid){0};
}

/* Of a node with what lies in a cell. */
static double node_covariance(const weft_kriged_grid *grid, int node, const weft_square_cell *cell)
{
    const double *row = grid->covariance + (size_t)node * (size_t)grid->node_count;
    double sum = 0;
    for (int k = 0; k < 4; k++)
        sum += (double)cell->weight[k] * row[cell->index[k]];
    return sum;
}

static double covariance(const weft_kriged_grid *grid, const weft_square_cell *a, const weft_square_cell *b)
{
    double sum = 0;
    for (int k = 0; k < 4; k++)
        sum += (double)a->weight[k] * node_covariance(grid, a->index[k], b);
    return sum;
}

/* ---- A map ---- */

void weft_kriged_map_free(weft_kriged_map *map)
{
    if (!map)
        return;
    free(map->cell);
    free(map->root);
    free(map->of_one);
    free(map);
}

/* Replaces columns [series][count] by the solutions. */
static void solve_columns(const weft_kriged_map *map, double *columns, int series)
{
    LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', map->places.count, series, map->root, map->places.count, columns,
                        map->places.count);
}

static weft_code factor(const weft_kriged_places *places, weft_kriged_map *map, weft_error *error)
{
    size_t count = (size_t)places->count;
    for (size_t i = 0; i < count; i++) {
        for (size_t j = i; j < count; j++)
            map->root[i * count + j] = covariance(places->grid, &map->cell[i], &map->cell[j]);
        map->root[i * count + i] += (double)places->nugget + (places->noise ? (double)places->noise[i] : 0);
    }
    if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', places->count, map->root, places->count) != 0)
        return weft_fail(error, WEFT_BAD_INPUT, "places that are no numbers have no covariance");
    for (size_t i = 0; i < count; i++)
        map->of_one[i] = 1;
    solve_columns(map, map->of_one, 1);
    for (size_t i = 0; i < count; i++)
        map->sum_of_one += map->of_one[i];
    return WEFT_OK;
}

weft_code weft_kriged_map_create(const weft_kriged_places *places, weft_kriged_map **result, weft_error *error)
{
    size_t count = (size_t)places->count;
    weft_kriged_map *map = calloc(1, sizeof *map);
    if (!map)
        return weft_fail_memory(error, "kriged map", sizeof *map);
    map->places = *places;
    map->places.noise = NULL;
    map->places.place = NULL;
    map->cell = malloc(count * sizeof *map->cell);
    map->root = malloc(count * count * sizeof *map->root);
    map->of_one = malloc(count * sizeof *map->of_one);
    weft_code code = WEFT_OK;
    if (!map->cell || !map->root || !map->of_one)
        code = weft_fail_memory(error, "kriged map", count * count * sizeof *map->root);
    if (code == WEFT_OK) {
        for (size_t i = 0; i < count; i++)
            map->cell[i] = weft_square_cell_at(places->place[i], places->grid->side);
        code = factor(places, map, error);
    }
    if (code == WEFT_OK)
        *result = map;
    else
        weft_kriged_map_free(map);
    return code;
}

/* ---- Values ---- */

/* Columns [series][count] of values, less the mean of each where the kriging is ordinary. */
static void take_columns(const weft_kriged_map *map, const float *value, int series, double *columns, double *mean)
{
    size_t count = (size_t)map->places.count;
    for (int s = 0; s < series; s++) {
        double *column = columns + (size_t)s * count, sum = 0;
        for (size_t i = 0; i < count; i++) {
            column[i] = (double)value[i * (size_t)series + (size_t)s];
            sum += map->of_one[i] * column[i];
        }
        mean[s] = map->places.ordinary ? sum / map->sum_of_one : 0;
        for (size_t i = 0; i < count; i++)
            column[i] -= mean[s];
    }
}

/* result [series] at one node: weight [count][series]. */
WEFT_HOT static void predict(const weft_kriged_map *map, const float *weight, const double *mean, int series, int node,
                             float *result)
{
    for (int s = 0; s < series; s++)
        result[s] = (float)mean[s];
    for (int i = 0; i < map->places.count; i++) {
        float c = (float)node_covariance(map->places.grid, node, &map->cell[i]);
        const float *row = weight + (size_t)i * (size_t)series;
        for (int s = 0; s < series; s++)
            result[s] += c * row[s];
    }
}

static void transpose(const double *columns, size_t count, int series, float *rows)
{
    for (size_t i = 0; i < count; i++)
        for (int s = 0; s < series; s++)
            rows[i * (size_t)series + (size_t)s] = (float)columns[(size_t)s * count + i];
}

weft_code weft_kriged_map_solve(const weft_kriged_map *map, const float *value, int series, float *node,
                                weft_error *error)
{
    size_t count = (size_t)map->places.count, all = count * (size_t)series;
    double *columns = malloc(all * sizeof *columns), *mean = malloc((size_t)series * sizeof *mean);
    float *weight = malloc(all * sizeof *weight);
    weft_code code = columns && mean && weight ? WEFT_OK : weft_fail_memory(error, "kriged map", all * sizeof *columns);
    if (code == WEFT_OK) {
        take_columns(map, value, series, columns, mean);
        solve_columns(map, columns, series);
        transpose(columns, count, series, weight);
        for (int i = 0; i < map->places.grid->node_count; i++)
            predict(map, weight, mean, series, i, node + (size_t)i * (size_t)series);
    }
    free(columns);
    free(mean);
    free(weight);
    return code;
}

/* ---- Errors ---- */

weft_code weft_kriged_map_variances(const weft_kriged_map *map, float *variance, weft_error *error)
{
    const weft_kriged_grid *grid = map->places.grid;
    size_t count = (size_t)map->places.count, nodes = (size_t)grid->node_count;
    double *column = malloc(count * nodes * sizeof *column);
    if (!column)
        return weft_fail_memory(error, "variances of a kriged map", count * nodes * sizeof *column);
    for (size_t i = 0; i < nodes; i++)
        for (size_t j = 0; j < count; j++)
            column[i * count + j] = node_covariance(grid, (int)i, &map->cell[j]);
    LAPACKE_dtrtrs_work(LAPACK_COL_MAJOR, 'L', 'N', 'N', map->places.count, grid->node_count, map->root,
                        map->places.count, column, map->places.count);
    for (size_t i = 0; i < nodes; i++) {
        double left = grid->covariance[i * nodes + i];
        for (size_t j = 0; j < count; j++)
            left -= column[i * count + j] * column[i * count + j];
        variance[i] = (float)fmax(left, 0);
    }
    free(column);
    return WEFT_OK;
}

weft_code weft_kriged_map_leave_out(const weft_kriged_map *map, const float *value, int series, float *residual,
                                    weft_error *error)
{
    size_t count = (size_t)map->places.count, all = count * (size_t)series;
    double *inverse = malloc(count * count * sizeof *inverse), *columns = malloc(all * sizeof *columns);
    double *mean = malloc((size_t)series * sizeof *mean);
    weft_code code = inverse && columns && mean
                         ? WEFT_OK
                         : weft_fail_memory(error, "leaving directions out", count * count * sizeof *inverse);
    if (code == WEFT_OK) {
        memcpy(inverse, map->root, count * count * sizeof *inverse);
        LAPACKE_dpotri_work(LAPACK_COL_MAJOR, 'L', map->places.count, inverse, map->places.count);
        take_columns(map, value, series, columns, mean);
        solve_columns(map, columns, series);
        for (size_t i = 0; i < count; i++) {
            double own = inverse[i * count + i];
            own -= map->places.ordinary ? map->of_one[i] * map->of_one[i] / map->sum_of_one : 0;
            for (size_t s = 0; s < (size_t)series; s++)
                residual[i * (size_t)series + s] = (float)(columns[s * count + i] / fmax(own, 1e-30));
        }
    }
    free(inverse);
    free(columns);
    free(mean);
    return code;
}
