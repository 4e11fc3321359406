/* Random inputs with the extremes over-sampled, and loops over millions of them. */
#ifndef WEFT_TESTS_REFLECTANCE_EXTREMES_H
#define WEFT_TESTS_REFLECTANCE_EXTREMES_H

#include "tests/reflectance/random.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/suite.h"

#include <stdbool.h>
#include <stdlib.h>

/* Room for rounding above a bound. */
#define EXTREMES_SLACK (1 + 1000 * (double)WEFT_REAL_EPSILON)

/* One of the values. */
#define EXTREMES_PICK(random, ...)                                                                                     \
    extremes_pick(random, (const double[]){__VA_ARGS__}, (int)(sizeof((const double[]){__VA_ARGS__}) / sizeof(double)))

static inline weft_real extremes_pick(uint64_t *random, const double *values, int count)
{
    return (weft_real)values[random_bits(random) % (unsigned)count];
}

/* Powers of ten between two exponents. */
static inline weft_real extremes_logarithmic(uint64_t *random, double low, double high)
{
    return (weft_real)pow(10.0, (double)random_between(random, low, high));
}

/* Grazing, along x or y, along the normal, or tied to `other`: the same, opposite, mirrored, nearly so. */
static inline weft_vec3 extremes_choice(uint64_t *random, weft_vec3 d, weft_vec3 other)
{
    weft_real tiny = EXTREMES_PICK(random, 0, 1e-38, 1e-30, 1e-12, 1e-7, 1e-4, 1e-3);
    switch (random_bits(random) % 10) {
    case 0:
        return weft_unit(weft_vec3_of(d.x, d.y, tiny));
    case 1:
        return weft_vec3_of(-other.x, -other.y, other.z);
    case 2:
        return weft_scale(other, -1);
    case 3:
        return other;
    case 4:
        return weft_unit(
            weft_vec3_of(EXTREMES_PICK(random, -1, 1), tiny * d.y, EXTREMES_PICK(random, 0, 1e-38, 1e-9, 1e-3)));
    case 5:
        return weft_unit(
            weft_vec3_of(tiny * d.x, EXTREMES_PICK(random, -1, 0, 1), EXTREMES_PICK(random, 1e-38, 1e-9, 1)));
    case 6:
        return weft_unit(weft_add(weft_vec3_of(-other.x, -other.y, other.z), weft_scale(d, tiny)));
    case 7:
        return weft_unit(weft_add(weft_vec3_of(-other.x, -other.y, -other.z), weft_scale(d, tiny)));
    default:
        return d;
    }
}

/* Squares of tiny components underflow: what is then no unit vector is replaced. */
static inline weft_vec3 extremes_direction(uint64_t *random, weft_vec3 other)
{
    weft_vec3 d = random_direction(random), chosen = extremes_choice(random, d, other);
    return fabs((double)weft_length(chosen) - 1) < 64 * (double)WEFT_REAL_EPSILON ? chosen : d;
}

static inline bool extremes_within(weft_real value, double bound)
{
    return value >= 0 && (double)value <= bound * EXTREMES_SLACK;
}

/* One random case; adds 1 to *lit where it gave light. False where a value is NaN, negative or above its bound. */
typedef bool extremes_case(uint64_t *random, long *lit);

enum { EXTREMES_BLOCK = 1000 };

/* Runs `count` cases on all cores, the same ones whatever their number, and fails the test where any is false or where
 * fewer than one in twenty gave light. */
static inline void extremes_run(extremes_case *check, long count)
{
    long bad = 0, lit = 0;
#pragma omp parallel for reduction(+ : bad, lit) schedule(dynamic)
    for (long block = 0; block < count / EXTREMES_BLOCK; block++) {
        uint64_t random = (uint64_t)block + 1;
        for (int i = 0; i < EXTREMES_BLOCK; i++)
            bad += !check(&random, &lit);
    }
    print_message("%ld cases, %ld lit, %ld bad\n", count, lit, bad);
    assert_int_equal(bad, 0);
    assert_true(lit > count / 20);
}

/* The number of cases: the first argument of the program. */
static inline long extremes_count(void)
{
    return suite_argument ? strtol(suite_argument, NULL, 10) : 100000;
}

#endif
