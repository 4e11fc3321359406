/* The floating-point type of the pure functions. `double` by default; the same sources
 * compiled with WEFT_REAL_IS_FLOAT give the single-precision library, whose results are
 * what a GPU can be expected to reach. The two must not be linked into one program. */
#ifndef WEFT_BASE_REAL_H
#define WEFT_BASE_REAL_H

#ifdef WEFT_REAL_IS_FLOAT
typedef float weft_real;
#define WEFT_REAL_EPSILON 6e-8
#else
typedef double weft_real;
#define WEFT_REAL_EPSILON 2e-16
#endif

#define WEFT_PI 3.14159265358979323846

/* Marks a hot loop: compiled for AVX-512, AVX2 and the baseline, chosen when the program starts, which is before the
 * sanitizers are ready. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&               \
    !defined(__SANITIZE_THREAD__)
#define WEFT_HOT __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define WEFT_HOT
#endif

#endif
