#include "capture/virtual/random.h"

static uint64_t mix(uint64_t z)
{
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

uint64_t weft_random_bits(uint64_t seed, weft_purpose purpose, uint64_t index)
{
    return mix(mix(mix(seed) + (uint64_t)purpose) + index);
}

static double uniform_of_bits(uint64_t bits)
{
    return (double)(bits >> 11) * 0x1p-53;
}

double weft_random_uniform(uint64_t seed, weft_purpose purpose, uint64_t index)
{
    return uniform_of_bits(weft_random_bits(seed, purpose, index));
}

static double normal_of_bits(uint64_t bits)
{
    double radius = sqrt(-2 * log(1 - uniform_of_bits(mix(bits))));
    return radius * cos(2 * WEFT_PI * uniform_of_bits(mix(bits + 1)));
}

double weft_random_normal(uint64_t seed, weft_purpose purpose, uint64_t index)
{
    return normal_of_bits(weft_random_bits(seed, purpose, index));
}

weft_vec3 weft_random_normal3(uint64_t seed, weft_purpose purpose, uint64_t index)
{
    uint64_t bits = weft_random_bits(seed, purpose, index);
    return (weft_vec3){normal_of_bits(bits), normal_of_bits(mix(bits ^ 1)), normal_of_bits(mix(bits ^ 2))};
}

weft_vec3 weft_random_direction(uint64_t seed, weft_purpose purpose, uint64_t index)
{
    uint64_t bits = weft_random_bits(seed, purpose, index);
    double z = 2 * uniform_of_bits(bits) - 1, phi = 2 * WEFT_PI * uniform_of_bits(mix(bits));
    double across = sqrt(1 - z * z);
    return (weft_vec3){across * cos(phi), across * sin(phi), z};
}
