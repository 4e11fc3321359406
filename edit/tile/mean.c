#include "edit/tile/search_steps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

weft_tile_place weft_tile_place_of(double at, double start, double period, int count)
{
    double turns = (at - start) / period, x = (turns - floor(turns)) * count - 0.5;
    int low = (int)floor(x);
    weft_tile_place place = {.low = (low + count) % count, .share = x - low};
    place.high = (place.low + 1) % count;
    return place;
}

weft_code weft_tile_mean_create(const weft_tile_pictures *pictures, int columns, int rows, weft_tile_mean *mean,
                                weft_error *error)
{
    size_t texels = (size_t)columns * (size_t)rows, places = (size_t)pictures->width + (size_t)pictures->height;
    *mean = (weft_tile_mean){.columns = columns, .rows = rows};
    mean->sum = malloc(texels * sizeof *mean->sum);
    mean->weight = malloc(texels * sizeof *mean->weight);
    mean->place = malloc(places * sizeof *mean->place);
    if (mean->sum && mean->weight && mean->place)
        return WEFT_OK;
    weft_tile_mean_free(mean);
    return weft_fail_memory(error, "mean tile", 2 * texels * sizeof *mean->sum);
}

void weft_tile_mean_free(weft_tile_mean *mean)
{
    free(mean->sum);
    free(mean->weight);
    free(mean->place);
    *mean = (weft_tile_mean){0};
}

static void put(weft_tile_mean *mean, int column, int row, double weight, double value)
{
    size_t i = (size_t)row * (size_t)mean->columns + (size_t)column;
    mean->sum[i] += weight * value;
    mean->weight[i] += weight;
}

static void put_row(const weft_tile_pictures *pictures, size_t first, weft_tile_place v, weft_tile_mean *mean)
{
    for (int x = 0; x < pictures->width; x++) {
        if (pictures->mask[first + (size_t)x])
            continue;
        double value = (double)pictures->value[first + (size_t)x];
        weft_tile_place u = mean->place[x];
        put(mean, u.low, v.low, (1 - u.share) * (1 - v.share), value);
        put(mean, u.high, v.low, u.share * (1 - v.share), value);
        put(mean, u.low, v.high, (1 - u.share) * v.share, value);
        put(mean, u.high, v.high, u.share * v.share, value);
    }
}

void weft_tile_mean_make(const weft_tile_pictures *pictures, int k, const weft_tile *tile, weft_tile_mean *mean)
{
    size_t texels = (size_t)mean->columns * (size_t)mean->rows;
    memset(mean->sum, 0, texels * sizeof *mean->sum);
    memset(mean->weight, 0, texels * sizeof *mean->weight);
    for (int x = 0; x < pictures->width; x++)
        mean->place[x] = weft_tile_place_of(x + 0.5, tile->left, tile->width, mean->columns);
    for (int y = 0; y < pictures->height; y++) {
        size_t first = ((size_t)k * (size_t)pictures->height + (size_t)y) * (size_t)pictures->width;
        put_row(pictures, first, weft_tile_place_of(y + 0.5, tile->top, tile->height, mean->rows), mean);
    }
    for (size_t i = 0; i < texels; i++)
        mean->sum[i] = mean->weight[i] > 0 ? mean->sum[i] / mean->weight[i] : 0;
}
