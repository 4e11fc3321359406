/* Well spread points that depend on nothing but their numbers: the (0, 2)-sequence of Sobol with hashed Owen scrambling
 * and shuffling (Burley 2020). Any thread computes any of them. Pure functions, private to this folder. */
#ifndef WEFT_GEOMETRY_LIGHT_SAMPLE_SEQUENCE_H
#define WEFT_GEOMETRY_LIGHT_SAMPLE_SEQUENCE_H

#include <stdint.h>

/* A 64-bit hash of two numbers, to make keys of keys (the finaliser of SplitMix64, Steele et al. 2014). */
static inline uint64_t weft_sequence_key(uint64_t key, uint64_t number)
{
    uint64_t z = key + (number + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* Point `index` of the sequence of a key, in [0, 1)^2. */
void weft_sequence_point(uint64_t key, uint32_t index, double point[2]);

#endif
