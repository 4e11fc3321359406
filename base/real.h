/* The floating-point type of the pure functions. `double` by default. The same sources compiled with
 * WEFT_REAL_IS_FLOAT give the single-precision library, whose results are what a GPU can be expected to reach, and with
 * WEFT_REAL_IS_QUAD (binary128, in software) the one that measures the rounding of the others. No two of them may share
 * the names of their functions: they must not be linked into one program, unless as shared libraries that hide them. */
#ifndef WEFT_BASE_REAL_H
#define WEFT_BASE_REAL_H

#if defined(WEFT_REAL_IS_FLOAT)
#define WEFT_REAL float
#define WEFT_REAL_EPSILON 6e-8
#define WEFT_PI 3.14159265358979323846
#elif defined(WEFT_REAL_IS_QUAD)
#define WEFT_REAL _Float128
#define WEFT_REAL_EPSILON 1e-34
#define WEFT_PI (__extension__ 3.14159265358979323846264338327950288f128)
#else
#define WEFT_REAL_EPSILON 2e-16
#define WEFT_PI 3.14159265358979323846
#endif

#include "weft/types.h"

/* Marks a hot loop: compiled for AVX-512, AVX2 and the baseline, chosen when the program starts, which is before the
 * sanitizers are ready. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&               \
    !defined(__SANITIZE_THREAD__)
#define WEFT_HOT __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define WEFT_HOT
#endif

#endif
