/* compress/layers/dots.h, for every instruction set. */
#include "compress/layers/dots.h"

#include "base/lanes.h"

/* Products that are added up together, so that each load serves several; and floats of a vector that are looked at in
 * one go, so that those of the tile stay in the first cache. */
#if defined(__AVX512F__)
enum { TILE = 4, STRETCH = 1024 };
#else
enum { TILE = 2, STRETCH = 1024 };
#endif

WEFT_DECLARE_DOTS(WEFT_INSTRUCTION_SET);

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* The products of TILE vectors with TILE others over one stretch, added to `result`. Beyond the end of a list its last
 * vector stands in, and what it gives is dropped. */
WEFT_INLINE void add_tile(const float *const *a, int a_left, const float *const *b, int b_left, size_t first,
                          size_t last, int stride, float *result)
{
    lanes sum[TILE][TILE];
    const float *x[TILE], *y[TILE];
#pragma GCC unroll 4
    for (int i = 0; i < TILE; i++) {
        x[i] = a[least(i, a_left - 1)];
        y[i] = b[least(i, b_left - 1)];
    }
#pragma GCC unroll 4
    for (int i = 0; i < TILE; i++)
#pragma GCC unroll 4
        for (int j = 0; j < TILE; j++)
            sum[i][j] = (lanes){0};
    for (size_t at = first; at < last; at += LANES) {
        lanes right[TILE];
#pragma GCC unroll 4
        for (int j = 0; j < TILE; j++)
            right[j] = lanes_load(y[j] + at);
#pragma GCC unroll 4
        for (int i = 0; i < TILE; i++) {
            lanes left = lanes_load(x[i] + at);
#pragma GCC unroll 4
            for (int j = 0; j < TILE; j++)
                sum[i][j] += left * right[j];
        }
    }
    for (int i = 0; i < least(TILE, a_left); i++)
        for (int j = 0; j < least(TILE, b_left); j++)
            result[i * stride + j] += lanes_sum(sum[i][j]);
}

void WEFT_KERNEL(weft_dots)(const float *const *a, int a_count, const float *const *b, int b_count, size_t length,
                            float *result)
{
    memset(result, 0, (size_t)a_count * (size_t)b_count * sizeof *result);
    for (size_t first = 0; first < length; first += STRETCH) {
        size_t last = first + STRETCH < length ? first + STRETCH : length;
        for (int i = 0; i < a_count; i += TILE)
            for (int j = 0; j < b_count; j += TILE)
                add_tile(a + i, a_count - i, b + j, b_count - j, first, last, b_count, result + i * b_count + j);
    }
}
