/* Equality of doubles within a bound; cmocka 1.1.5 compares floats only. */
#ifndef WEFT_TESTS_REGISTRATION_NEAR_H
#define WEFT_TESTS_REGISTRATION_NEAR_H

#include <math.h>

#define assert_near(seen, expected, bound) assert_true(fabs((double)(seen) - (double)(expected)) <= (bound))

#endif
