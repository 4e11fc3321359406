/* import/bonn/product.h, for every instruction set. */
#include "import/bonn/product.h"

#include "base/lanes.h"

/* Vectors of texels whose products are added up together with WEFT_BONN_TOGETHER images: as many sums as the processor
 * has under way at once. */
#if defined(__AVX512F__)
enum { ACROSS = 4 };
#else
enum { ACROSS = 2 };
#endif

/* Images WEFT_BONN_TOGETHER from `row` on; beyond the last of them it stands in. */
WEFT_INLINE void multiply_tile(const float *const *row, int rows_left, const float *texels, int component_count,
                               float *values)
{
    lanes sum[WEFT_BONN_TOGETHER][ACROSS];
    const float *weight[WEFT_BONN_TOGETHER];
#pragma GCC unroll 4
    for (int i = 0; i < WEFT_BONN_TOGETHER; i++) {
        weight[i] = row[i < rows_left ? i : rows_left - 1];
#pragma GCC unroll 4
        for (int j = 0; j < ACROSS; j++)
            sum[i][j] = (lanes){0};
    }
    for (int k = 0; k < component_count; k++) {
        lanes texel[ACROSS];
#pragma GCC unroll 4
        for (int j = 0; j < ACROSS; j++)
            texel[j] = lanes_load(texels + (size_t)k * WEFT_BONN_BLOCK + j * LANES);
#pragma GCC unroll 4
        for (int i = 0; i < WEFT_BONN_TOGETHER; i++)
#pragma GCC unroll 4
            for (int j = 0; j < ACROSS; j++)
                sum[i][j] += weight[i][k] * texel[j];
    }
#pragma GCC unroll 4
    for (int i = 0; i < WEFT_BONN_TOGETHER; i++)
#pragma GCC unroll 4
        for (int j = 0; j < ACROSS; j++)
            lanes_store(values + (size_t)i * WEFT_BONN_BLOCK + j * LANES, sum[i][j]);
}

static void multiply(const float *const *row, int row_count, const float *texels, int component_count, float *values)
{
    for (int i = 0; i < row_count; i += WEFT_BONN_TOGETHER)
        for (int j = 0; j < WEFT_BONN_BLOCK; j += ACROSS * LANES)
            multiply_tile(row + i, row_count - i, texels + j, component_count,
                          values + (size_t)i * WEFT_BONN_BLOCK + j);
}

static void widen(const weft_half *half, size_t count, float *single)
{
#if defined(__F16C__)
    for (size_t i = 0; i < count; i += 8)
        _mm256_storeu_ps(single + i, _mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)(half + i))));
#else
    for (size_t i = 0; i < count; i++)
        single[i] = weft_float_of_half(half[i]);
#endif
}

WEFT_DECLARE_BONN_KERNELS_OF(WEFT_INSTRUCTION_SET);
const weft_bonn_kernels WEFT_KERNEL(weft_bonn_kernels) = {multiply, widen};
