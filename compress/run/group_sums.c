#include "compress/run/group_sums.h"

#include "base/processor.h"
#include "compress/run/group_kernel.h"

#include <string.h>

WEFT_DECLARE_GROUP_KERNELS(baseline);
#if defined(__x86_64__)
WEFT_DECLARE_GROUP_KERNELS(avx2);
WEFT_DECLARE_GROUP_KERNELS(avx512);
#endif

static void convert(const weft_half *half, size_t count, float *result)
{
#if defined(__x86_64__)
    weft_instruction_set set = weft_processor_instruction_set();
    if (set == WEFT_AVX512)
        weft_group_convert_avx512(half, count, result);
    else if (set == WEFT_AVX2)
        weft_group_convert_avx2(half, count, result);
    else
#endif
        weft_group_convert_baseline(half, count, result);
}

/* Forgets the samples that do not count. */
static long drop_masked(const uint8_t *mask, const uint8_t *held_out, size_t image_count, float *group)
{
    long masked = 0;
    float *count = group + 3 * image_count;
    for (size_t i = 0; i < image_count; i++) {
        int held = held_out && held_out[i];
        masked += mask[i] && !held;
        if (!mask[i] && !held)
            continue;
        count[i] = 0;
        memset(group + 3 * i, 0, 3 * sizeof *group);
    }
    return masked;
}

long weft_group_of_texel(const weft_half *samples, const uint8_t *mask, const uint8_t *held_out, size_t image_count,
                         float *group)
{
    convert(samples, 3 * image_count, group);
    unsigned any = held_out != NULL;
    for (size_t i = 0; i < image_count; i++) {
        group[3 * image_count + i] = 1;
        any |= mask[i];
    }
    return any ? drop_masked(mask, held_out, image_count, group) : 0;
}

void weft_group_add(const float *from, size_t image_count, float *to)
{
#if defined(__x86_64__)
    weft_instruction_set set = weft_processor_instruction_set();
    if (set == WEFT_AVX512)
        weft_group_accumulate_avx512(from, 4 * image_count, to);
    else if (set == WEFT_AVX2)
        weft_group_accumulate_avx2(from, 4 * image_count, to);
    else
#endif
        weft_group_accumulate_baseline(from, 4 * image_count, to);
}
