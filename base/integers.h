/* The smaller and the larger of two whole numbers. Pure functions. */
#ifndef WEFT_BASE_INTEGERS_H
#define WEFT_BASE_INTEGERS_H

static inline int weft_smaller(int a, int b)
{
    return a < b ? a : b;
}

static inline int weft_larger(int a, int b)
{
    return a > b ? a : b;
}

#endif
