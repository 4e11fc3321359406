/* Vectors of floats for the hot loops. A source that uses them is compiled once for every instruction set
 * (weft_kernels in cmake/weft_build.cmake) and only ever called through a table of functions that base/processor.h
 * chooses; WEFT_KERNEL gives each copy of a function its own name. */
#ifndef WEFT_BASE_LANES_H
#define WEFT_BASE_LANES_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

#if defined(__AVX512F__)
enum { LANES = 16 };
#elif defined(__AVX2__)
enum { LANES = 8 };
#else
enum { LANES = 4 }; /* SSE2, NEON */
#endif

#define WEFT_KERNEL_JOIN(name, set) name##_##set
#define WEFT_KERNEL_NAME(name, set) WEFT_KERNEL_JOIN(name, set)
#define WEFT_KERNEL(name) WEFT_KERNEL_NAME(name, WEFT_INSTRUCTION_SET)

#define WEFT_INLINE static inline __attribute__((always_inline))

typedef float lanes __attribute__((vector_size(4 * LANES)));
typedef int32_t lane_bits __attribute__((vector_size(4 * LANES)));

WEFT_INLINE lanes lanes_of(float x)
{
    return x - (lanes){0};
}

/* `from` is a multiple of the size of a vector. */
WEFT_INLINE lanes lanes_load(const float *from)
{
    return *(const lanes *)__builtin_assume_aligned(from, 4 * LANES);
}

WEFT_INLINE void lanes_store(float *to, lanes x)
{
    *(lanes *)__builtin_assume_aligned(to, 4 * LANES) = x;
}

/* from[index] for every lane. */
WEFT_INLINE lanes lanes_gather(const float *from, lane_bits index)
{
#if defined(__AVX512F__)
    return (lanes)_mm512_i32gather_ps((__m512i)index, from, 4);
#elif defined(__AVX2__)
    return (lanes)_mm256_i32gather_ps(from, (__m256i)index, 4);
#else
    return (lanes){from[index[0]], from[index[1]], from[index[2]], from[index[3]]};
#endif
}

WEFT_INLINE lanes lanes_sqrt(lanes x)
{
#if defined(__AVX512F__)
    return (lanes)_mm512_sqrt_ps((__m512)x);
#elif defined(__AVX2__)
    return (lanes)_mm256_sqrt_ps((__m256)x);
#else
    return (lanes){sqrtf(x[0]), sqrtf(x[1]), sqrtf(x[2]), sqrtf(x[3])};
#endif
}

/* `mask` is all ones or zero in each lane, as comparisons give it. */
WEFT_INLINE lanes lanes_select(lane_bits mask, lanes yes, lanes no)
{
    return (lanes)(((lane_bits)yes & mask) | ((lane_bits)no & ~mask));
}

WEFT_INLINE lane_bits lane_bits_select(lane_bits mask, lane_bits yes, lane_bits no)
{
    return (yes & mask) | (no & ~mask);
}

/* b where one is no number. */
WEFT_INLINE lanes lanes_max(lanes a, lanes b)
{
#if defined(__AVX512F__)
    return (lanes)_mm512_max_ps((__m512)a, (__m512)b);
#elif defined(__AVX2__)
    return (lanes)_mm256_max_ps((__m256)a, (__m256)b);
#else
    return lanes_select(a > b, a, b);
#endif
}

WEFT_INLINE lanes lanes_min(lanes a, lanes b)
{
#if defined(__AVX512F__)
    return (lanes)_mm512_min_ps((__m512)a, (__m512)b);
#elif defined(__AVX2__)
    return (lanes)_mm256_min_ps((__m256)a, (__m256)b);
#else
    return lanes_select(a < b, a, b);
#endif
}

WEFT_INLINE lanes lanes_where(lane_bits mask, lanes x)
{
    return (lanes)((lane_bits)x & mask);
}

WEFT_INLINE lane_bits lane_bits_load(const int32_t *from)
{
    return *(const lane_bits *)__builtin_assume_aligned(from, 4 * LANES);
}

/* Half and half, from the whole vector to the first element of four. Shuffles keep it in registers: parts of an array
 * are stored and waited for. */
typedef float weft_four_lanes __attribute__((vector_size(16)));

WEFT_INLINE float lanes_sum(lanes x)
{
#if defined(__AVX512F__)
    typedef float eight_lanes __attribute__((vector_size(32)));
    eight_lanes eight = __builtin_shufflevector(x, x, 0, 1, 2, 3, 4, 5, 6, 7) +
                        __builtin_shufflevector(x, x, 8, 9, 10, 11, 12, 13, 14, 15);
#elif defined(__AVX2__)
    lanes eight = x;
#endif
#if defined(__AVX2__)
    weft_four_lanes four =
        __builtin_shufflevector(eight, eight, 0, 1, 2, 3) + __builtin_shufflevector(eight, eight, 4, 5, 6, 7);
#else
    weft_four_lanes four = x;
#endif
    weft_four_lanes two = four + __builtin_shufflevector(four, four, 2, 3, 0, 1);
    return two[0] + two[1];
}

/* Several vectors in step, so that the long chain of one hides behind the others: the processor looks ahead too little
 * to overlap them where one comes after the other. */
enum { WEFT_EACH_MAX = 3 };
#define WEFT_EACH(count) _Pragma("GCC unroll 4") for (int i = 0; i < (count); i++)

/* log2 of positive normal floats: t P(t) with the mantissa 1 + t in [sqrt(1/2), sqrt(2)) and P the polynomial of
 * degree 8 of least relative error (2.6e-8), so that the result stays accurate near 1, which high exponents need. */
WEFT_INLINE void lanes_log2_each(int count, const lanes *x, lanes *result)
{
    static const float coefficient[] = {0.125837043f,  -0.207269818f, 0.215715632f,  -0.238944814f, 0.287916243f,
                                        -0.360703677f, 0.480910629f,  -0.721347332f, 1.44269502f};
    lanes t[WEFT_EACH_MAX], p[WEFT_EACH_MAX], whole[WEFT_EACH_MAX];
    WEFT_EACH (count) {
        lane_bits bits = (lane_bits)x[i], exponent = (bits - 0x3f3504f3) >> 23;
        t[i] = (lanes)(bits - (exponent << 23)) - 1;
        whole[i] = __builtin_convertvector(exponent, lanes);
        p[i] = lanes_of(coefficient[0]);
    }
#pragma GCC unroll 8
    for (int k = 1; k < 9; k++)
        WEFT_EACH (count)
            p[i] = coefficient[k] + t[i] * p[i];
    WEFT_EACH (count)
        result[i] = whole[i] + t[i] * p[i];
}

/* 2^x for x <= 127; below x = -126 a number of at most 2^-126. An integer power and, for the rest in [-1/2, 1/2], the
 * polynomial of degree 5 of least relative error (7.5e-8). */
WEFT_INLINE void lanes_exp2_each(int count, const lanes *x, lanes *result)
{
    static const float coefficient[] = {0.00132764725f, 0.00967554189f, 0.0555071309f,
                                        0.240221202f,   0.693146944f,   1.00000012f};
    lanes n[WEFT_EACH_MAX], f[WEFT_EACH_MAX], p[WEFT_EACH_MAX];
    WEFT_EACH (count) {
#if defined(__AVX512F__)
        n[i] = (lanes)_mm512_roundscale_ps((__m512)x[i], _MM_FROUND_TO_NEAREST_INT);
        f[i] = x[i] - n[i];
#else
        /* 3 2^22 leaves no bits for a fraction: the last bits of the sum are the nearest whole number. */
        lanes clamped = lanes_max(x[i], lanes_of(-126));
        n[i] = clamped + 12582912.0f;
        f[i] = clamped - (n[i] - 12582912.0f);
#endif
        p[i] = lanes_of(coefficient[0]);
    }
#pragma GCC unroll 8
    for (int k = 1; k < 6; k++)
        WEFT_EACH (count)
            p[i] = coefficient[k] + f[i] * p[i];
#if defined(__AVX512F__)
    WEFT_EACH (count)
        result[i] = (lanes)_mm512_scalef_ps((__m512)p[i], (__m512)n[i]);
#else
    WEFT_EACH (count)
        result[i] = (lanes)((lane_bits)p[i] + ((lane_bits)n[i] << 23));
#endif
}

WEFT_INLINE lanes lanes_exp2(lanes x)
{
    lanes result;
    lanes_exp2_each(1, &x, &result);
    return result;
}

#endif
