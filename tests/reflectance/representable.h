/* Reference values that single precision cannot hold. */
#ifndef WEFT_TESTS_REFLECTANCE_REPRESENTABLE_H
#define WEFT_TESTS_REFLECTANCE_REPRESENTABLE_H

#include "tests/reflectance/vectors.h"

#include <float.h>

/* Below this a value has no relative accuracy in the precision of the build. */
#define LEAST_NORMAL ((WEFT_REAL_EPSILON < 1e-9) ? DBL_MIN : (double)FLT_MIN)

/* vectors_check; where the expected value is not 0 but below LEAST_NORMAL, within that. */
static inline void check_representable(reference_vectors *v, int row, const char *column, double actual)
{
    double expected = fabs(vectors_number(v, row, column));
    if (expected > 0 && expected < LEAST_NORMAL)
        vectors_check_within(v, row, column, actual, LEAST_NORMAL);
    else
        vectors_check(v, row, column, actual);
}

#endif
