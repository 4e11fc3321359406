#include "bench/fit/arithmetic_floor.h"

#define DECLARE(set) float execute_multiply_adds_##set(double count)

DECLARE(baseline);
#if defined(__x86_64__)
DECLARE(avx2);
DECLARE(avx512);
#endif

int pass_multiply_adds(int lobe_count)
{
    int columns = 2 + 4 * lobe_count, pairs = lobe_count * (lobe_count - 1) / 2;
    return 9 * lobe_count + 2 + columns * (columns + 1) / 2 - 3 * pairs - 1;
}

float execute_multiply_adds(weft_instruction_set set, double count)
{
#if defined(__x86_64__)
    if (set == WEFT_AVX512)
        return execute_multiply_adds_avx512(count);
    if (set == WEFT_AVX2)
        return execute_multiply_adds_avx2(count);
#endif
    (void)set;
    return execute_multiply_adds_baseline(count);
}
