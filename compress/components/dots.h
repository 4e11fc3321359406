/* Scalar products of many long vectors with many others: the loop in which components spend their time. */
#ifndef WEFT_COMPRESS_COMPONENTS_DOTS_H
#define WEFT_COMPRESS_COMPONENTS_DOTS_H

#include "base/processor.h"

#include <stddef.h>

#define WEFT_DECLARE_DOTS(set)                                                                                         \
    void weft_dots_##set(const float *const *a, int a_count, const float *const *b, int b_count, size_t length,        \
                         float *result)

WEFT_FOR_EACH_SET(WEFT_DECLARE_DOTS);

/* result [a_count][b_count] = a_i . b_j, vectors of `length` floats, a multiple of 16, aligned to 64 bytes. Each
 * product is added up in the same order, whatever the counts. */
static inline void weft_dots(const float *const *a, int a_count, const float *const *b, int b_count, size_t length,
                             float *result)
{
    WEFT_DISPATCH(weft_dots)(a, a_count, b, b_count, length, result);
}

#endif
