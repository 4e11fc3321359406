/* The loops of compress/run/group_sums.h, compiled once for every instruction set. */
#ifndef WEFT_COMPRESS_RUN_GROUP_KERNEL_H
#define WEFT_COMPRESS_RUN_GROUP_KERNEL_H

#include "base/half.h"

#include <stddef.h>

#define WEFT_DECLARE_GROUP_KERNELS_OF(set)                                                                             \
    void weft_group_convert_##set(const weft_half *half, size_t count, float *result);                                 \
    void weft_group_accumulate_##set(const float *from, size_t count, float *to)
#define WEFT_DECLARE_GROUP_KERNELS(set) WEFT_DECLARE_GROUP_KERNELS_OF(set)

#endif
