/* The two irregularities of cloth (Irawan and Marschner 2012, 7.2.1), from 32-bit integer hashes so that C and GLSL
 * agree. Private to the room. */
#ifndef WEFT_REFLECTANCE_WEAVE_NOISE_H
#define WEFT_REFLECTANCE_WEAVE_NOISE_H

#include "base/vector.h"

#include <stdbool.h>
#include <stdint.h>

/* A segment of the endless cloth: its centre in quarters of a cell. The pieces of a segment that crosses the border of
 * a tile are different yarns of the file but have the same centre here. */
typedef struct weft_segment_place {
    int64_t quarter_x, quarter_y;
    bool warp;
} weft_segment_place;

/* Exponentially distributed with mean 1, constant on each of fineness x fineness rectangles of a segment.
 * `across`, `along` in [0, 1]: position in the segment. */
weft_real weft_weave_intensity_noise(uint64_t seed, weft_segment_place place, weft_real fineness, weft_real across,
                                     weft_real along);

/* One-dimensional gradient noise (Perlin 1985, fade of 2002) in [-1, 1] along the warp or weft yarn through the centre
 * of a segment. `period` in cells. */
weft_real weft_weave_yarn_noise(uint64_t seed, weft_segment_place place, bool along_warp, weft_real period);

#endif
