/* Reproducible random numbers for tests: the same on every machine. */
#ifndef WEFT_TESTS_REFLECTANCE_RANDOM_H
#define WEFT_TESTS_REFLECTANCE_RANDOM_H

#include "base/vector.h"

#include <stdint.h>

/* splitmix64 (Steele, Lea and Flood 2014). */
static inline uint64_t random_bits(uint64_t *state)
{
    uint64_t x = *state += 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

/* In [low, high). */
static inline weft_real random_between(uint64_t *state, double low, double high)
{
    return (weft_real)(low + (high - low) * ((double)(random_bits(state) >> 40) / 16777216));
}

/* Cosine-weighted on the upper hemisphere. */
static inline weft_vec3 random_direction(uint64_t *state)
{
    weft_real z2 = random_between(state, 0, 1), phi = random_between(state, 0, 2 * (double)WEFT_PI);
    weft_real radius = sqrt(1 - z2);
    return weft_unit(weft_vec3_of(radius * cos(phi), radius * sin(phi), sqrt(z2) + (weft_real)1e-4));
}

#endif
