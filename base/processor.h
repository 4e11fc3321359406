/* Which instruction set the hot loops use, and the handling of denormal floats. */
#ifndef WEFT_BASE_PROCESSOR_H
#define WEFT_BASE_PROCESSOR_H

#include "base/status.h"

/* In the order of preference, worst first. */
typedef enum weft_instruction_set {
    WEFT_BASELINE, /* SSE2 on x86-64, NEON on aarch64 */
    WEFT_AVX2,     /* with FMA and F16C: x86-64-v3 */
    WEFT_AVX512,   /* x86-64-v4 */
    WEFT_INSTRUCTION_SETS
} weft_instruction_set;

/* What a processor has; WEFT_HAS_AVX512 is F, BW, DQ and VL together. */
enum { WEFT_HAS_AVX2 = 1, WEFT_HAS_FMA = 2, WEFT_HAS_F16C = 4, WEFT_HAS_AVX512 = 8 };

/* "baseline", "avx2", "avx512". Pure. */
const char *weft_instruction_set_name(weft_instruction_set set);

/* The best set of a processor with these flags. Pure. */
weft_instruction_set weft_instruction_set_of(unsigned flags);

/* The best set of this processor. Pure. */
weft_instruction_set weft_processor_best(void);

/* The one in use, found once: the best, or what the environment variable WEFT_ISA names where that is available.
 * Thread-safe. */
weft_instruction_set weft_processor_instruction_set(void);

/* From now on the best that is no better than `most`, whatever WEFT_ISA says: for tests and benches, which compare
 * sets. Thread-safe. */
void weft_processor_limit(weft_instruction_set most);

/* Errors: WEFT_BAD_USAGE where WEFT_ISA names no instruction set, or one that this processor lacks. */
weft_code weft_processor_check(weft_error *error);

/* The kernel NAME of the set in use: NAME_baseline, NAME_avx2 or NAME_avx512, which are compiled of one source (see
 * base/lanes.h). NAME may begin with `&`: a table of functions. */
#if defined(__x86_64__)
#define WEFT_DISPATCH(name)                                                                                            \
    (weft_processor_instruction_set() == WEFT_AVX512 ? name##_avx512                                                   \
     : weft_processor_instruction_set() == WEFT_AVX2 ? name##_avx2                                                     \
                                                     : name##_baseline)
#else
#define WEFT_DISPATCH(name) (name##_baseline)
#endif

/* DECLARE(set) for each set that there are kernels of. */
#if defined(__x86_64__)
#define WEFT_FOR_EACH_SET(DECLARE)                                                                                     \
    DECLARE(baseline);                                                                                                 \
    DECLARE(avx2);                                                                                                     \
    DECLARE(avx512)
#else
#define WEFT_FOR_EACH_SET(DECLARE) DECLARE(baseline)
#endif

/* Denormal floats cost a hundred cycles each and mean nothing in a fit: from here on this thread takes them for 0.
 * Returns the state to restore. */
unsigned weft_denormals_off(void);
void weft_denormals_restore(unsigned state);

#endif
