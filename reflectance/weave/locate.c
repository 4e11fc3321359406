/* Where a point of the cloth lies, and the two irregularities of cloth there (Irawan and Marschner 2012, 7.2.1), from
 * 32-bit integer hashes so that C and GLSL agree. */
#include "reflectance/weave/weave.h"

#include "btf/direction/direction.h"

#include <stdlib.h>

/* A segment of the endless cloth: its centre in quarters of a cell. The pieces of a segment that crosses the border of
 * a tile are different yarns of the file but have the same centre here. */
typedef struct segment_place {
    int64_t quarter_x, quarter_y;
    bool warp;
} segment_place;

/* ---- Noise ---- */

/* Keeps the three uses of one seed apart. */
enum { STREAM_INTENSITY = 1, STREAM_WARP = 2, STREAM_WEFT = 3 };

/* Bijective mixer of 32 bits with low bias (Wellons 2018, "lowbias32"). */
static uint32_t mixed(uint32_t x)
{
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

static uint32_t start(uint64_t seed, uint32_t stream)
{
    return mixed(mixed(mixed(stream) + (uint32_t)seed) + (uint32_t)(seed >> 32));
}

static uint32_t fold(uint32_t hash, int64_t value)
{
    return mixed(hash + (uint32_t)value);
}

/* In (0, 1): the middles of 2^24 parts. Single precision holds those of the lower half exactly. */
static weft_real unit_interval(uint32_t hash)
{
    return ((weft_real)(hash >> 8) + (weft_real)0.5) / (weft_real)16777216;
}

/* -log of unit_interval. Next to 1 it is about the distance from 1, which is exact where the number is not. */
static weft_real minus_log(uint32_t hash)
{
    return hash >> 31 ? -log1p(-unit_interval(~hash)) : -log(unit_interval(hash));
}

/* Exponentially distributed with mean 1, constant on each of fineness x fineness rectangles of a segment.
 * `across`, `along` in [0, 1]: position in the segment. */
static weft_real intensity_noise(uint64_t seed, segment_place place, weft_real fineness, weft_real across,
                                 weft_real along)
{
    uint32_t hash = start(seed, STREAM_INTENSITY);
    hash = fold(fold(hash, place.quarter_x), place.quarter_y);
    hash = fold(hash, place.warp);
    hash = fold(fold(hash, (int64_t)floor(across * fineness)), (int64_t)floor(along * fineness));
    return minus_log(hash);
}

/* Floor of quarters / 4. */
static int64_t cell_of(int64_t quarters)
{
    return quarters >= 0 ? quarters / 4 : -((3 - quarters) / 4);
}

/* One-dimensional gradient noise (Perlin 1985, fade of 2002) in [-1, 1] along the warp or weft yarn through the centre
 * of a segment. `period` in cells. */
static weft_real yarn_noise(uint64_t seed, segment_place place, bool along_warp, weft_real period)
{
    int64_t yarn = cell_of(along_warp ? place.quarter_x : place.quarter_y);
    weft_real position = (weft_real)(along_warp ? place.quarter_y : place.quarter_x) / 4 / period;
    weft_real knot = floor(position), t = position - knot;
    uint32_t hash = fold(start(seed, along_warp ? STREAM_WARP : STREAM_WEFT), yarn);
    weft_real before = 2 * unit_interval(fold(hash, (int64_t)knot)) - 1;
    weft_real after = 2 * unit_interval(fold(hash, (int64_t)knot + 1)) - 1;
    weft_real fade = t * t * t * (t * (t * 6 - 15) + 10);
    /* Gradients of +-1 reach +-1/2 half way between knots. */
    return 2 * (before * t + fade * (after * (t - 1) - before * t));
}

/* ---- Places ---- */

/* Beyond this many tiles a coordinate says nothing about the place within one. */
#define MAX_COORDINATE 1e9

/* A coordinate in cells, split into the tile and the place within it. */
typedef struct tiled {
    weft_real tile;  /* whole number */
    weft_real local; /* cells, [0, size) */
    int cell;
} tiled;

static tiled split(weft_real tiles, int size)
{
    weft_real tile = floor(tiles), local = (tiles - tile) * (weft_real)size;
    int cell = (int)local;
    return (tiled){tile, local, cell < size ? cell : size - 1};
}

static weft_real finite_coordinate(weft_real x)
{
    return fabs(x) < (weft_real)MAX_COORDINATE ? x : 0;
}

/* Places along y count upward, tiles down. */
static segment_place place_of(const weft_weave *weave, const weft_yarn *yarn, weft_real tile_x, weft_real tile_y)
{
    weft_real center_x = (tile_x + yarn->center_u) * (weft_real)weave->tile_width;
    weft_real center_y = (yarn->center_v - tile_y) * (weft_real)weave->tile_height;
    return (segment_place){llround(4 * center_x), llround(4 * center_y), yarn->warp};
}

static weft_real umax_offset(const weft_weave *weave, const weft_yarn *yarn, segment_place place, uint64_t seed)
{
    const weft_real *amplitude_deg = weave->inclination_noise_deg + (yarn->warp ? 0 : 2);
    weft_real offset_deg = amplitude_deg[0] * yarn_noise(seed, place, true, weave->period) +
                           amplitude_deg[1] * yarn_noise(seed, place, false, weave->period);
    weft_real umax = yarn->segment.umax;
    return weft_clamp(umax + weft_rad_of_deg(offset_deg), yarn->min_umax, yarn->max_umax) - umax;
}

static void add_noise(const weft_weave *weave, segment_place place, uint64_t seed, weft_weave_point *point)
{
    const weft_yarn *yarn = &weave->yarn[point->yarn];
    const weft_segment *segment = &yarn->segment;
    if (weave->period > 0)
        point->umax_offset_rad = umax_offset(weave, yarn, place, seed);
    if (weave->fineness > 0)
        point->intensity = intensity_noise(seed, place, weave->fineness, point->x / segment->width + (weft_real)0.5,
                                           point->y / segment->length + (weft_real)0.5);
}

weft_weave_point weft_weave_locate(const weft_weave *weave, weft_real U, weft_real V, uint64_t seed)
{
    tiled across = split(finite_coordinate(U), weave->tile_width);
    tiled down = split(1 - finite_coordinate(V), weave->tile_height);
    int index = weave->pattern[down.cell * weave->tile_width + across.cell];
    const weft_yarn *yarn = &weave->yarn[index];
    weft_real dx = across.local - yarn->center_u * (weft_real)weave->tile_width;
    weft_real dy = down.local - (1 - yarn->center_v) * (weft_real)weave->tile_height;
    weft_weave_point point = {.yarn = index, .x = yarn->warp ? dx : dy, .y = yarn->warp ? -dy : dx, .intensity = 1};
    if (seed && yarn->admissible)
        add_noise(weave, place_of(weave, yarn, across.tile, down.tile), seed, &point);
    return point;
}

static int ascending(const void *a, const void *b)
{
    weft_real x = *(const weft_real *)a, y = *(const weft_real *)b;
    return (x > y) - (x < y);
}

void weft_weave_umax_offsets(const weft_weave *weave, int yarn, weft_real offset_rad[WEFT_WEAVE_OFFSETS])
{
    /* Steps of a few hundred tiles that have no factor in common with usual tiles and periods. */
    enum { CLASS = 64, COUNT = CLASS * WEFT_WEAVE_OFFSETS, STEP_X = 211, STEP_Y = 307, SEED = 1 };
    const weft_yarn *y = &weave->yarn[yarn];
    weft_real offset[COUNT] = {0};
    for (int i = 0; i < COUNT && weave->period > 0 && y->admissible; i++)
        offset[i] = umax_offset(weave, y, place_of(weave, y, (weft_real)(STEP_X * i), (weft_real)(STEP_Y * i)), SEED);
    qsort(offset, COUNT, sizeof *offset, ascending);
    for (int k = 0; k < WEFT_WEAVE_OFFSETS; k++) {
        offset_rad[k] = 0;
        for (int i = k * CLASS; i < (k + 1) * CLASS; i++)
            offset_rad[k] += offset[i] / CLASS;
    }
}
