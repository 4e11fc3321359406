#include "edit/blend/steps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A grid as small as this is solved from zero. */
enum { LEAST_SIDE = 4 };

/* Residuals below this share of the right side are none. */
static const double solved = 1e-4;

typedef struct grid {
    int width, height;
} grid;

static size_t texels_of(grid g)
{
    return (size_t)g.width * (size_t)g.height;
}

static size_t texel_at(grid g, int x, int y)
{
    return (size_t)y * (size_t)g.width + (size_t)x;
}

weft_code weft_membrane_create(int width, int height, weft_membrane *membrane, weft_error *error)
{
    size_t texels = texels_of((grid){width, height});
    float *room = calloc(3 * texels, sizeof *room);
    *membrane = (weft_membrane){width, height, {room, room ? room + texels : NULL}, room ? room + 2 * texels : NULL};
    return room ? WEFT_OK : weft_fail_memory(error, "the membrane", 3 * texels * sizeof *room);
}

void weft_membrane_free(weft_membrane *membrane)
{
    free(membrane->step[0]);
    *membrane = (weft_membrane){0};
}

/* ---- One grid: A field = right, where A takes the sum of the four neighbours from four times the texel ---- */

static void apply(grid g, const float *field, float *result)
{
#pragma omp parallel for if (g.height > 128)
    for (int y = 0; y < g.height; y++) {
        int above = y > 0 ? y - 1 : g.height - 1, below = y + 1 < g.height ? y + 1 : 0;
        for (int x = 0; x < g.width; x++) {
            int before = x > 0 ? x - 1 : g.width - 1, after = x + 1 < g.width ? x + 1 : 0;
            result[texel_at(g, x, y)] = 4 * field[texel_at(g, x, y)] - field[texel_at(g, before, y)] -
                                        field[texel_at(g, after, y)] - field[texel_at(g, x, above)] -
                                        field[texel_at(g, x, below)];
        }
    }
}

static double product(const float *a, const float *b, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += (double)a[i] * (double)b[i];
    return sum;
}

/* Conjugate gradients from the field as it is. room [3][texels]. */
static void relax(grid g, const float *right, float *field, float *room)
{
    size_t texels = texels_of(g);
    float *residual = room, *direction = room + texels, *image = room + 2 * texels;
    apply(g, field, image);
    for (size_t i = 0; i < texels; i++)
        direction[i] = residual[i] = right[i] - image[i];
    double enough = solved * solved * product(right, right, texels), square = product(residual, residual, texels);
    for (int step = 0; step < 4 * (g.width + g.height) && square > enough; step++) {
        apply(g, direction, image);
        double along = product(direction, image, texels), before = square;
        if (!(along > 0))
            return;
        float length = (float)(square / along);
        for (size_t i = 0; i < texels; i++) {
            field[i] += length * direction[i];
            residual[i] -= length * image[i];
        }
        square = product(residual, residual, texels);
        float turn = (float)(square / before);
        for (size_t i = 0; i < texels; i++)
            direction[i] = residual[i] + turn * direction[i];
    }
}

/* ---- From coarse to fine ---- */

static grid half_of(grid g)
{
    return (grid){(g.width + 1) / 2, (g.height + 1) / 2};
}

/* room [5][texels] of the grid: of coarser ones the right side, the field and what they need in turn are in it. */
static void solve(grid g, const float *right, float *field, float *room)
{
    memset(field, 0, texels_of(g) * sizeof *field);
    if (g.width > LEAST_SIDE && g.height > LEAST_SIDE) {
        grid half = half_of(g);
        float *half_right = room, *half_field = room + texels_of(half);
        memset(half_right, 0, texels_of(half) * sizeof *half_right);
        for (int y = 0; y < g.height; y++)
            for (int x = 0; x < g.width; x++)
                half_right[texel_at(half, x / 2, y / 2)] += right[texel_at(g, x, y)];
        solve(half, half_right, half_field, half_field + texels_of(half));
        for (int y = 0; y < g.height; y++)
            for (int x = 0; x < g.width; x++)
                field[texel_at(g, x, y)] = half_field[texel_at(half, x / 2, y / 2)];
    }
    relax(g, right, field, room);
}

static void take_mean(float *field, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += (double)field[i];
    float mean = (float)(sum / (double)count);
    for (size_t i = 0; i < count; i++)
        field[i] -= mean;
}

weft_code weft_membrane_solve(weft_membrane *membrane, weft_error *error)
{
    grid g = {membrane->width, membrane->height};
    size_t texels = texels_of(g);
    /* Grids of a few texels are no quarter of those twice as fine: some more room. */
    size_t count = 6 * texels + 1024;
    float *right = calloc(count, sizeof *right);
    if (!right)
        return weft_fail_memory(error, "the membrane", count * sizeof *right);
    for (int y = 0; y < g.height; y++)
        for (int x = 0; x < g.width; x++) {
            size_t here = texel_at(g, x, y), after = texel_at(g, (x + 1) % g.width, y),
                   below = texel_at(g, x, (y + 1) % g.height);
            right[after] += membrane->step[0][here];
            right[here] -= membrane->step[0][here] + membrane->step[1][here];
            right[below] += membrane->step[1][here];
        }
    solve(g, right, membrane->value, right + texels);
    take_mean(membrane->value, texels);
    free(right);
    return WEFT_OK;
}
