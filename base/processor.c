#include "base/processor.h"

#include <stdlib.h>
#include <string.h>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

const char *weft_instruction_set_name(weft_instruction_set set)
{
    static const char *const name[WEFT_INSTRUCTION_SETS] = {"baseline", "avx2", "avx512"};
    return name[set];
}

weft_instruction_set weft_processor_best(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
        return WEFT_AVX512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        return WEFT_AVX2;
#endif
    return WEFT_BASELINE;
}

/* The set of a name, WEFT_INSTRUCTION_SETS for none. */
static weft_instruction_set set_of_name(const char *name)
{
    int set = 0;
    while (set < WEFT_INSTRUCTION_SETS && strcmp(name, weft_instruction_set_name((weft_instruction_set)set)) != 0)
        set++;
    return (weft_instruction_set)set;
}

weft_instruction_set weft_processor_instruction_set(void)
{
    const char *wanted = getenv("WEFT_ISA");
    weft_instruction_set best = weft_processor_best(), set = wanted ? set_of_name(wanted) : best;
    return set < best ? set : best;
}

weft_code weft_processor_check(weft_error *error)
{
    const char *wanted = getenv("WEFT_ISA");
    if (!wanted)
        return WEFT_OK;
    weft_instruction_set set = set_of_name(wanted);
    if (set == WEFT_INSTRUCTION_SETS)
        return weft_fail(error, WEFT_BAD_USAGE, "WEFT_ISA is '%s', not baseline, avx2 or avx512", wanted);
    if (set > weft_processor_best())
        return weft_fail(error, WEFT_BAD_USAGE, "WEFT_ISA is '%s', which this processor lacks", wanted);
    return WEFT_OK;
}

#if defined(__x86_64__)

enum { FLUSH_TO_ZERO = 0x8000, DENORMALS_ARE_ZERO = 0x0040 };

unsigned weft_denormals_off(void)
{
    unsigned state = _mm_getcsr();
    _mm_setcsr(state | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
    return state;
}

void weft_denormals_restore(unsigned state)
{
    _mm_setcsr(state);
}

#elif defined(__aarch64__)

enum { FLUSH_TO_ZERO = 1 << 24 };

unsigned weft_denormals_off(void)
{
    unsigned long state;
    __asm__ volatile("mrs %0, fpcr" : "=r"(state));
    __asm__ volatile("msr fpcr, %0" : : "r"(state | FLUSH_TO_ZERO));
    return (unsigned)state;
}

void weft_denormals_restore(unsigned state)
{
    __asm__ volatile("msr fpcr, %0" : : "r"((unsigned long)state));
}

#else

unsigned weft_denormals_off(void)
{
    return 0;
}

void weft_denormals_restore(unsigned state)
{
    (void)state;
}

#endif
