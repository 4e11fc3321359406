/* Random numbers as pure functions of what they are for: (seed, purpose, index) always gives the same value, in
 * whatever order and by whatever number of threads it is asked for. */
#ifndef WEFT_CAPTURE_VIRTUAL_RANDOM_H
#define WEFT_CAPTURE_VIRTUAL_RANDOM_H

#include "base/vector.h"

#include <stdint.h>

/* What a random number is for: numbers of different purposes are independent. */
typedef enum weft_purpose {
    WEFT_RANDOM_CALIBRATION,
    WEFT_RANDOM_MOUNTING,
    WEFT_RANDOM_VIEWPOINT,
    WEFT_RANDOM_LIGHT,
    WEFT_RANDOM_POWER,
    WEFT_RANDOM_FAULT,
    WEFT_RANDOM_NOISE,
    WEFT_RANDOM_PIXEL,
    WEFT_RANDOM_CLOTH,
    WEFT_RANDOM_HAND,
    WEFT_RANDOM_AXIS,
    WEFT_RANDOM_SENSOR
} weft_purpose;

/* 64 random bits (the finaliser of SplitMix64, Steele, Lea and Flood 2014, applied to each argument in turn). */
uint64_t weft_random_bits(uint64_t seed, weft_purpose purpose, uint64_t index);

/* Uniform in [0, 1). */
double weft_random_uniform(uint64_t seed, weft_purpose purpose, uint64_t index);

/* Standard normal (Box and Muller 1958). */
double weft_random_normal(uint64_t seed, weft_purpose purpose, uint64_t index);

/* Three independent standard normals. */
weft_vec3 weft_random_normal3(uint64_t seed, weft_purpose purpose, uint64_t index);

/* A uniformly distributed unit vector. */
weft_vec3 weft_random_direction(uint64_t seed, weft_purpose purpose, uint64_t index);

#endif
