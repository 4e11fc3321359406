/* Vectors of floats for the hot loops. A source that uses them is compiled once for every instruction set
 * (weft_kernels in cmake/weft_build.cmake) and only ever called through a table of functions that btf/processor.h
 * chooses; WEFT_KERNEL gives each copy of a function its own name. */
#ifndef WEFT_BTF_LANES_H
#define WEFT_BTF_LANES_H

#include <math.h>
#include <stdint.h>

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

WEFT_INLINE lanes lanes_where(lane_bits mask, lanes x)
{
    return (lanes)((lane_bits)x & mask);
}

WEFT_INLINE lane_bits lane_bits_load(const int32_t *from)
{
    return *(const lane_bits *)__builtin_assume_aligned(from, 4 * LANES);
}

WEFT_INLINE float lanes_sum(lanes x)
{
    float sum = 0;
    for (int i = 0; i < LANES; i++)
        sum += x[i];
    return sum;
}

/* log2 of positive normal floats: t P(t) with the mantissa 1 + t in [sqrt(1/2), sqrt(2)) and P the polynomial of
 * degree 8 of least relative error (2.6e-8), so that the result stays accurate near 1, which high exponents need. */
WEFT_INLINE lanes lanes_log2(lanes x)
{
    lane_bits bits = (lane_bits)x;
    lane_bits exponent = (bits - 0x3f3504f3) >> 23;
    lanes t = (lanes)(bits - (exponent << 23)) - 1;
    lanes p = -0.207269818f + t * 0.125837043f;
    p = -0.238944814f + t * (0.215715632f + t * p);
    p = -0.360703677f + t * (0.287916243f + t * p);
    p = -0.721347332f + t * (0.480910629f + t * p);
    return __builtin_convertvector(exponent, lanes) + t * (1.44269502f + t * p);
}

/* x = n + f with a whole n and f in [-1/2, 1/2]; returns f. */
WEFT_INLINE lanes lanes_split(lanes x, lanes *n)
{
#if defined(__AVX512F__)
    *n = (lanes)_mm512_roundscale_ps((__m512)x, _MM_FROUND_TO_NEAREST_INT);
#else
    *n = __builtin_convertvector(__builtin_convertvector(x + 127.5f, lane_bits), lanes) - 127;
#endif
    return x - *n;
}

/* p 2^n for a whole n from -126 to 127. */
WEFT_INLINE lanes lanes_scale(lanes p, lanes n)
{
#if defined(__AVX512F__)
    return (lanes)_mm512_scalef_ps((__m512)p, (__m512)n);
#else
    return p * (lanes)(__builtin_convertvector(n + 127, lane_bits) << 23);
#endif
}

/* 2^x for x <= 127; below x = -126 a number of at most 2^-126. An integer power and, for the rest, the polynomial of
 * degree 5 of least relative error (7.5e-8). */
WEFT_INLINE lanes lanes_exp2(lanes x)
{
#if !defined(__AVX512F__)
    x = lanes_select(x > -126.0f, x, lanes_of(-126));
#endif
    lanes n, f = lanes_split(x, &n);
    lanes p = 0.00967554189f + f * 0.00132764725f;
    p = 0.240221202f + f * (0.0555071309f + f * p);
    return lanes_scale(1.00000012f + f * (0.693146944f + f * p), n);
}

#endif
