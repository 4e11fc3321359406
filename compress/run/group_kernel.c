/* The loops of compress/run/group_sums.h that touch every sample. */
#include "compress/run/group_sums.h"

#include "base/lanes.h"

#if defined(__F16C__)
#include <immintrin.h>
#endif

void WEFT_KERNEL(weft_group_convert)(const weft_half *half, size_t count, float *result)
{
    size_t i = 0;
#if defined(__F16C__)
    for (; i + 8 <= count; i += 8)
        _mm256_storeu_ps(result + i, _mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)(const void *)(half + i))));
#endif
    for (; i < count; i++)
        result[i] = weft_float_of_half(half[i]);
}

void WEFT_KERNEL(weft_group_accumulate)(const float *from, size_t count, float *to)
{
    for (size_t i = 0; i < count; i++)
        to[i] += from[i];
}
