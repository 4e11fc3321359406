/* The loops of compress/group_sums.h that touch every sample. */
#include "compress/group_kernel.h"

#include "btf/lanes.h"

WEFT_DECLARE_GROUP_KERNELS(WEFT_INSTRUCTION_SET);

void WEFT_KERNEL(weft_group_convert)(const weft_half *half, size_t count, float *result)
{
    for (size_t i = 0; i < count; i++)
        result[i] = weft_float_of_half(half[i]);
}

void WEFT_KERNEL(weft_group_accumulate)(const float *from, size_t count, float *to)
{
    for (size_t i = 0; i < count; i++)
        to[i] += from[i];
}
