/* The smaller and the larger of two whole numbers, and the nearest int. Pure functions. */
#ifndef WEFT_BASE_INTEGERS_H
#define WEFT_BASE_INTEGERS_H

#include <limits.h>
#include <stdint.h>

static inline int weft_smaller(int a, int b)
{
    return a < b ? a : b;
}

static inline int weft_larger(int a, int b)
{
    return a > b ? a : b;
}

/* Of a number beyond all ints the last one: out of every range that is checked afterwards. */
static inline int weft_limited_int(int64_t value)
{
    return value > INT_MAX ? INT_MAX : value < INT_MIN ? INT_MIN : (int)value;
}

#endif
