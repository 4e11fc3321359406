/* Eight floats in step: the features of a place. One register of AVX2, two of SSE2 and NEON. For kernels only. */
#ifndef WEFT_RELIEF_EIGHT_H
#define WEFT_RELIEF_EIGHT_H

#include "base/lanes.h"

typedef float eight __attribute__((vector_size(32)));

WEFT_INLINE eight eight_load(const float *from)
{
    eight x;
    memcpy(&x, from, sizeof x);
    return x;
}

WEFT_INLINE void eight_store(float *to, eight x)
{
    memcpy(to, &x, sizeof x);
}

WEFT_INLINE float eight_sum(eight x)
{
    typedef float four __attribute__((vector_size(16)));
    four half[2];
    memcpy(half, &x, sizeof x);
    half[0] += half[1];
    return (half[0][0] + half[0][2]) + (half[0][1] + half[0][3]);
}

#endif
