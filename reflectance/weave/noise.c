#include "reflectance/weave/noise.h"

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

/* In (0, 1): 24 bits, so that single precision holds it exactly. */
static weft_real unit_interval(uint32_t hash)
{
    return ((weft_real)(hash >> 8) + (weft_real)0.5) / (weft_real)16777216;
}

weft_real weft_weave_intensity_noise(uint64_t seed, weft_segment_place place, weft_real fineness, weft_real across,
                                     weft_real along)
{
    uint32_t hash = start(seed, STREAM_INTENSITY);
    hash = fold(fold(hash, place.quarter_x), place.quarter_y);
    hash = fold(hash, place.warp);
    hash = fold(fold(hash, (int64_t)floor(across * fineness)), (int64_t)floor(along * fineness));
    return -log(unit_interval(hash));
}

/* Floor of quarters / 4. */
static int64_t cell_of(int64_t quarters)
{
    return quarters >= 0 ? quarters / 4 : -((3 - quarters) / 4);
}

weft_real weft_weave_yarn_noise(uint64_t seed, weft_segment_place place, bool along_warp, weft_real period)
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
