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

/* "baseline", "avx2", "avx512". Pure. */
const char *weft_instruction_set_name(weft_instruction_set set);

/* The best that this processor and this build have. Pure. */
weft_instruction_set weft_processor_best(void);

/* The one in use: the best, or what the environment variable WEFT_ISA names where that is available. Thread-safe. */
weft_instruction_set weft_processor_instruction_set(void);

/* Errors: WEFT_BAD_USAGE where WEFT_ISA names no instruction set, or one that this processor lacks. */
weft_code weft_processor_check(weft_error *error);

/* Denormal floats cost a hundred cycles each and mean nothing in a fit: from here on this thread takes them for 0.
 * Returns the state to restore. */
unsigned weft_denormals_off(void);
void weft_denormals_restore(unsigned state);

#endif
