#include "base/processor.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#if defined(__x86_64__)
#include <cpuid.h>
#include <immintrin.h>
#endif

const char *weft_instruction_set_name(weft_instruction_set set)
{
    static const char *const name[WEFT_INSTRUCTION_SETS] = {"baseline", "avx2", "avx512"};
    return name[set];
}

weft_instruction_set weft_instruction_set_of(unsigned flags)
{
    const unsigned avx2 = WEFT_HAS_AVX2 | WEFT_HAS_FMA | WEFT_HAS_F16C, avx512 = avx2 | WEFT_HAS_AVX512;
    return (flags & avx512) == avx512 ? WEFT_AVX512 : (flags & avx2) == avx2 ? WEFT_AVX2 : WEFT_BASELINE;
}

#if defined(__x86_64__)

/* Of the first leaf of CPUID: not every compiler's __builtin_cpu_supports knows it. */
static bool has_f16c(void)
{
    unsigned a, b, c, d;
    return __get_cpuid(1, &a, &b, &c, &d) && (c & bit_F16C);
}

/* The compiler's own checks ask the system, too, whether it keeps the registers. */
static unsigned find_flags(void)
{
    unsigned flags = 0;
    flags |= __builtin_cpu_supports("avx2") ? WEFT_HAS_AVX2 : 0;
    flags |= __builtin_cpu_supports("fma") ? WEFT_HAS_FMA : 0;
    flags |= has_f16c() ? WEFT_HAS_F16C : 0;
    bool is_v4 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                 __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    return flags | (is_v4 ? WEFT_HAS_AVX512 : 0);
}

#else

static unsigned find_flags(void)
{
    return 0;
}

#endif

weft_instruction_set weft_processor_best(void)
{
    return weft_instruction_set_of(find_flags());
}

/* The set of a name, WEFT_INSTRUCTION_SETS for none. */
static weft_instruction_set set_of_name(const char *name)
{
    int set = 0;
    while (set < WEFT_INSTRUCTION_SETS && strcmp(name, weft_instruction_set_name((weft_instruction_set)set)) != 0)
        set++;
    return (weft_instruction_set)set;
}

/* The set in use plus one; 0 until it is asked for. */
static atomic_int in_use;

void weft_processor_limit(weft_instruction_set most)
{
    weft_instruction_set best = weft_processor_best();
    atomic_store_explicit(&in_use, 1 + (int)(most < best ? most : best), memory_order_relaxed);
}

weft_instruction_set weft_processor_instruction_set(void)
{
    int set = atomic_load_explicit(&in_use, memory_order_relaxed);
    if (set == 0) {
        const char *wanted = getenv("WEFT_ISA");
        weft_processor_limit(wanted ? set_of_name(wanted) : WEFT_INSTRUCTION_SETS);
        set = atomic_load_explicit(&in_use, memory_order_relaxed);
    }
    return (weft_instruction_set)(set - 1);
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
