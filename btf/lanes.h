/* Vectors of floats for the hot loops. A source that uses them is compiled once for every instruction set
 * (weft_kernels in cmake/weft_build.cmake) and only ever called through a table of functions that btf/processor.h
 * chooses; WEFT_KERNEL gives each copy of a function its own name. */
#ifndef WEFT_BTF_LANES_H
#define WEFT_BTF_LANES_H

#include <stdint.h>

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

/* Doubles: half as many. */
enum { WIDE_LANES = LANES / 2 };
typedef double wide_lanes __attribute__((vector_size(8 * WIDE_LANES)));
typedef int64_t wide_bits __attribute__((vector_size(8 * WIDE_LANES)));
typedef float wide_lanes_source __attribute__((vector_size(4 * WIDE_LANES)));

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

/* `mask` is all ones or zero in each lane, as comparisons give it. */
WEFT_INLINE lanes lanes_select(lane_bits mask, lanes yes, lanes no)
{
    return (lanes)(((lane_bits)yes & mask) | ((lane_bits)no & ~mask));
}

WEFT_INLINE lanes lanes_where(lane_bits mask, lanes x)
{
    return (lanes)((lane_bits)x & mask);
}

WEFT_INLINE float lanes_sum(lanes x)
{
    float sum = 0;
    for (int i = 0; i < LANES; i++)
        sum += x[i];
    return sum;
}

/* log2 of positive normal floats: the mantissa m in [sqrt(1/2), sqrt(2)) through atanh((m - 1) / (m + 1)). Relative
 * error below 2e-7 also near 1, which high exponents need. */
WEFT_INLINE lanes lanes_log2(lanes x)
{
    lane_bits bits = (lane_bits)x;
    lane_bits exponent = (bits - 0x3f3504f3) >> 23;
    lanes m = (lanes)(bits - (exponent << 23));
    lanes s = (m - 1) / (m + 1);
    lanes s2 = s * s;
    const float ln2 = 0.69314718f;
    lanes series = 1 + s2 * (1.0f / 3 + s2 * (1.0f / 5 + s2 * (1.0f / 7 + s2 * (1.0f / 9))));
    return __builtin_convertvector(exponent, lanes) + 2 / ln2 * s * series;
}

/* 2^x for x <= 127; 2^-126 below x = -126. An integer power and the Taylor series of the rest; relative error 2e-7. */
WEFT_INLINE lanes lanes_exp2(lanes x)
{
    x = lanes_select(x < -126.0f, lanes_of(-126), x);
    lane_bits biased = __builtin_convertvector(x + 127.5f, lane_bits);
    const float ln2 = 0.69314718f;
    lanes f = (x + 127 - __builtin_convertvector(biased, lanes)) * ln2;
    lanes series =
        1 + f * (1 + f * (1.0f / 2 + f * (1.0f / 6 + f * (1.0f / 24 + f * (1.0f / 120 + f * (1.0f / 720))))));
    return series * (lanes)(biased << 23);
}

WEFT_INLINE wide_lanes wide_of(double x)
{
    return x - (wide_lanes){0};
}

WEFT_INLINE wide_lanes wide_load(const double *from)
{
    return *(const wide_lanes *)__builtin_assume_aligned(from, 8 * WIDE_LANES);
}

/* WIDE_LANES floats as doubles. */
WEFT_INLINE wide_lanes wide_load_floats(const float *from)
{
    return __builtin_convertvector(*(const wide_lanes_source *)__builtin_assume_aligned(from, 4 * WIDE_LANES),
                                   wide_lanes);
}

WEFT_INLINE void wide_store(double *to, wide_lanes x)
{
    *(wide_lanes *)__builtin_assume_aligned(to, 8 * WIDE_LANES) = x;
}

WEFT_INLINE wide_lanes wide_select(wide_bits mask, wide_lanes yes, wide_lanes no)
{
    return (wide_lanes)(((wide_bits)yes & mask) | ((wide_bits)no & ~mask));
}

WEFT_INLINE double wide_sum(wide_lanes x)
{
    double sum = 0;
    for (int i = 0; i < WIDE_LANES; i++)
        sum += x[i];
    return sum;
}

#endif
