#include "compress/components/dots.h"

#include "base/processor.h"

WEFT_DECLARE_DOTS(baseline);
#if defined(__x86_64__)
WEFT_DECLARE_DOTS(avx2);
WEFT_DECLARE_DOTS(avx512);
#endif

void weft_dots(const float *const *a, int a_count, const float *const *b, int b_count, size_t length, float *result)
{
#if defined(__x86_64__)
    weft_instruction_set set = weft_processor_instruction_set();
    if (set == WEFT_AVX512)
        weft_dots_avx512(a, a_count, b, b_count, length, result);
    else if (set == WEFT_AVX2)
        weft_dots_avx2(a, a_count, b, b_count, length, result);
    else
#endif
        weft_dots_baseline(a, a_count, b, b_count, length, result);
}
