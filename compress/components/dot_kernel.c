/* compress/components/dots.h, for every instruction set. */
#include "compress/components/dots.h"

#include "base/lanes.h"

/* Products that are added up together, DOWN vectors with ACROSS others: each load serves several, and as many sums go
 * on as the processor has under way at once. And floats of a vector that are looked at in one go, so that those of the
 * tile stay in the first cache. */
#if defined(__AVX512F__)
enum { DOWN = 4, ACROSS = 4, STRETCH = 1024 };
#else
enum { DOWN = 4, ACROSS = 2, STRETCH = 1024 };
#endif

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* The products of DOWN vectors with ACROSS others over one stretch, added to `result`. Beyond the end of a list its
 * last vector stands in, and what it gives is dropped. */
WEFT_INLINE void add_tile(const float *const *a, int a_left, const float *const *b, int b_left, size_t first,
                          size_t last, int stride, float *result)
{
    lanes sum[DOWN][ACROSS];
    const float *x[DOWN], *y[ACROSS];
#pragma GCC unroll 4
    for (int i = 0; i < DOWN; i++)
        x[i] = a[least(i, a_left - 1)];
#pragma GCC unroll 4
    for (int j = 0; j < ACROSS; j++)
        y[j] = b[least(j, b_left - 1)];
#pragma GCC unroll 4
    for (int i = 0; i < DOWN; i++)
#pragma GCC unroll 4
        for (int j = 0; j < ACROSS; j++)
            sum[i][j] = (lanes){0};
    for (size_t at = first; at < last; at += LANES) {
        lanes right[ACROSS];
#pragma GCC unroll 4
        for (int j = 0; j < ACROSS; j++)
            right[j] = lanes_load(y[j] + at);
#pragma GCC unroll 4
        for (int i = 0; i < DOWN; i++) {
            lanes left = lanes_load(x[i] + at);
#pragma GCC unroll 4
            for (int j = 0; j < ACROSS; j++)
                sum[i][j] += left * right[j];
        }
    }
#pragma GCC unroll 4
    for (int i = 0; i < DOWN; i++)
#pragma GCC unroll 4
        for (int j = 0; j < ACROSS; j++) {
            if (i < a_left && j < b_left)
                result[i * stride + j] += lanes_sum(sum[i][j]);
        }
}

void WEFT_KERNEL(weft_dots)(const float *const *a, int a_count, const float *const *b, int b_count, size_t length,
                            float *result)
{
    memset(result, 0, (size_t)a_count * (size_t)b_count * sizeof *result);
    for (size_t first = 0; first < length; first += STRETCH) {
        size_t last = first + STRETCH < length ? first + STRETCH : length;
        for (int i = 0; i < a_count; i += DOWN)
            for (int j = 0; j < b_count; j += ACROSS)
                add_tile(a + i, a_count - i, b + j, b_count - j, first, last, b_count, result + i * b_count + j);
    }
}
