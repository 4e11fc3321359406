/* Rows of numbers that the kernels of the bound take a vector at a time: whole lanes, aligned, zero at first. */
#ifndef WEFT_COMPRESS_TEXEL_PEAK_ROWS_H
#define WEFT_COMPRESS_TEXEL_PEAK_ROWS_H

#include "compress/fit/normal.h"

#include <stdlib.h>
#include <string.h>

static inline int weft_whole_lanes(int count)
{
    return (count + WEFT_STRIP_LANES - 1) / WEFT_STRIP_LANES * WEFT_STRIP_LANES;
}

/* The caller frees; NULL where memory fails. */
static inline void *weft_lane_row(int count)
{
    size_t bytes = (size_t)count * sizeof(float);
    void *row = aligned_alloc(64, bytes);
    if (row)
        memset(row, 0, bytes);
    return row;
}

#endif
