#include "geometry/stitch/segment_grid.h"

#include <stdlib.h>
#include <string.h>

enum { MAX_BUCKETS = 1 << 21, MAX_ENTRIES = 1 << 24, MAX_BUCKETS_ACROSS = 256 };

/* Half open ranges of buckets of the endless grid. */
typedef struct bucket_box {
    int low[3], high[3];
} bucket_box;

static weft_real yarn_reach(const weft_stitch_yarn *yarn, weft_real margin)
{
    return fmax(yarn->radius_side, yarn->radius_up) + margin;
}

static void find_bounds(const weft_yarn_skeleton *skeleton, weft_real margin, weft_segment_grid *grid,
                        weft_real *smallest_reach)
{
    *smallest_reach = INFINITY;
    grid->bottom = INFINITY;
    grid->top = -INFINITY;
    for (int i = 0; i < skeleton->strand_count; i++) {
        const weft_yarn_strand *strand = &skeleton->strand[i];
        weft_real reach = yarn_reach(&skeleton->stitch->yarn[strand->yarn], margin);
        *smallest_reach = fmin(*smallest_reach, reach);
        for (int k = 0; k < strand->station_count; k++) {
            weft_real z = skeleton->station[strand->first_station + k].at.z;
            grid->bottom = fmin(grid->bottom, z - reach);
            grid->top = fmax(grid->top, z + reach);
        }
    }
}

static int buckets_across(weft_real extent, weft_real wanted)
{
    return (int)weft_clamp(floor(extent / wanted), 1, MAX_BUCKETS_ACROSS);
}

static bucket_box box_of_segment(const weft_segment_grid *grid, const weft_yarn_strand *strand, int station,
                                 weft_real margin)
{
    const weft_yarn_station *a = &grid->skeleton->station[station], *b = a + 1;
    weft_real reach = yarn_reach(&grid->skeleton->stitch->yarn[strand->yarn], margin);
    const weft_real low[3] = {fmin(a->at.x, b->at.x), fmin(a->at.y, b->at.y), fmin(a->at.z, b->at.z) - grid->bottom};
    const weft_real high[3] = {fmax(a->at.x, b->at.x), fmax(a->at.y, b->at.y), fmax(a->at.z, b->at.z) - grid->bottom};
    const weft_real size[3] = {grid->bucket.x, grid->bucket.y, grid->bucket.z};
    bucket_box box;
    for (int i = 0; i < 3; i++) {
        box.low[i] = (int)floor((low[i] - reach) / size[i]);
        box.high[i] = (int)floor((high[i] + reach) / size[i]) + 1;
    }
    box.low[2] = box.low[2] < 0 ? 0 : box.low[2];
    box.high[2] = box.high[2] > grid->count[2] ? grid->count[2] : box.high[2];
    return box;
}

static size_t bucket_of(const weft_segment_grid *grid, int x, int y, int z)
{
    return ((size_t)z * (size_t)grid->count[1] + (size_t)y) * (size_t)grid->count[0] + (size_t)x;
}

static int floor_divide(int a, int b)
{
    return a >= 0 ? a / b : -((-a + b - 1) / b);
}

/* Counts a segment in its buckets, or stores it there where `fill` is given. */
static void list_segment(weft_segment_grid *grid, const bucket_box *box, int strand, int station, size_t *fill)
{
    for (int z = box->low[2]; z < box->high[2]; z++) {
        for (int y = box->low[1]; y < box->high[1]; y++) {
            for (int x = box->low[0]; x < box->high[0]; x++) {
                int tiles_x = floor_divide(x, grid->count[0]), tiles_y = floor_divide(y, grid->count[1]);
                size_t bucket = bucket_of(grid, x - tiles_x * grid->count[0], y - tiles_y * grid->count[1], z);
                if (fill)
                    grid->segment[fill[bucket]++] = (weft_near_segment){strand, station, -tiles_x, -tiles_y};
                else
                    grid->start[bucket + 1]++;
            }
        }
    }
}

static void list_all(weft_segment_grid *grid, weft_real margin, size_t *fill)
{
    const weft_yarn_skeleton *skeleton = grid->skeleton;
    for (int i = 0; i < skeleton->strand_count; i++) {
        const weft_yarn_strand *strand = &skeleton->strand[i];
        for (int k = 0; k + 1 < strand->station_count; k++) {
            bucket_box box = box_of_segment(grid, strand, strand->first_station + k, margin);
            list_segment(grid, &box, i, strand->first_station + k, fill);
        }
    }
}

/* Entries of all lists, without making them. */
static double entry_count(const weft_segment_grid *grid, weft_real margin)
{
    double total = 0;
    for (int i = 0; i < grid->skeleton->strand_count; i++) {
        const weft_yarn_strand *strand = &grid->skeleton->strand[i];
        for (int k = 0; k + 1 < strand->station_count; k++) {
            bucket_box box = box_of_segment(grid, strand, strand->first_station + k, margin);
            total += (double)(box.high[0] - box.low[0]) * (box.high[1] - box.low[1]) * (box.high[2] - box.low[2]);
        }
    }
    return total;
}

static weft_code fill_lists(weft_segment_grid *grid, weft_real margin, size_t buckets, weft_error *error)
{
    list_all(grid, margin, NULL);
    for (size_t i = 0; i < buckets; i++)
        grid->start[i + 1] += grid->start[i];
    size_t *fill = malloc((buckets + 1) * sizeof *fill);
    grid->segment = malloc((grid->start[buckets] + 1) * sizeof *grid->segment);
    if (!fill || !grid->segment) {
        free(fill);
        return weft_fail_memory(error, "segments of yarns", grid->start[buckets] * sizeof *grid->segment);
    }
    memcpy(fill, grid->start, buckets * sizeof *fill);
    list_all(grid, margin, fill);
    free(fill);
    return WEFT_OK;
}

weft_code weft_segment_grid_create(const weft_yarn_skeleton *skeleton, weft_real margin, const char *path,
                                   weft_segment_grid *grid, weft_error *error)
{
    const weft_stitch *stitch = skeleton->stitch;
    weft_real reach;
    *grid = (weft_segment_grid){.skeleton = skeleton};
    find_bounds(skeleton, margin, grid, &reach);
    weft_real wanted = reach / 2;
    grid->count[0] = buckets_across(stitch->width, wanted);
    grid->count[1] = buckets_across(stitch->height, wanted);
    grid->count[2] = buckets_across(grid->top - grid->bottom, wanted);
    grid->bucket = weft_vec3_of(stitch->width / grid->count[0], stitch->height / grid->count[1],
                                (grid->top - grid->bottom) / grid->count[2]);
    size_t buckets = (size_t)grid->count[0] * (size_t)grid->count[1] * (size_t)grid->count[2];
    double entries = entry_count(grid, margin);
    if (buckets > MAX_BUCKETS || entries > MAX_ENTRIES)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: too much yarn for one tile (%g entries in %zu buckets)", path,
                         entries, buckets);
    grid->start = calloc(buckets + 1, sizeof *grid->start);
    weft_code code = grid->start ? fill_lists(grid, margin, buckets, error)
                                 : weft_fail_memory(error, "buckets", buckets * sizeof *grid->start);
    if (code != WEFT_OK)
        weft_segment_grid_free(grid);
    return code;
}

void weft_segment_grid_free(weft_segment_grid *grid)
{
    free(grid->start);
    free(grid->segment);
    *grid = (weft_segment_grid){0};
}

static weft_real wrap(weft_real x, weft_real period)
{
    weft_real wrapped = x - period * floor(x / period);
    return wrapped < period ? wrapped : 0;
}

weft_vec3 weft_place_in_tile(const weft_stitch *stitch, weft_vec3 place)
{
    return weft_vec3_of(wrap(place.x, stitch->width), wrap(place.y, stitch->height), place.z);
}

static int bucket_index(weft_real x, weft_real size, int count)
{
    int index = (int)(x / size);
    return index < count ? index : count - 1;
}

const weft_near_segment *weft_segments_near(const weft_segment_grid *grid, weft_vec3 place, size_t *count)
{
    *count = 0;
    if (!(place.z >= grid->bottom && place.z <= grid->top))
        return NULL;
    int x = bucket_index(place.x, grid->bucket.x, grid->count[0]);
    int y = bucket_index(place.y, grid->bucket.y, grid->count[1]);
    int z = bucket_index(place.z - grid->bottom, grid->bucket.z, grid->count[2]);
    size_t bucket = bucket_of(grid, x, y, z);
    *count = grid->start[bucket + 1] - grid->start[bucket];
    return grid->segment + grid->start[bucket];
}
