#include "geometry/light/sample_sequence.h"

static uint32_t reverse_bits(uint32_t x)
{
    x = x << 16 | x >> 16;
    x = (x & 0x00ff00ffu) << 8 | (x & 0xff00ff00u) >> 8;
    x = (x & 0x0f0f0f0fu) << 4 | (x & 0xf0f0f0f0u) >> 4;
    x = (x & 0x33333333u) << 2 | (x & 0xccccccccu) >> 2;
    return (x & 0x55555555u) << 1 | (x & 0xaaaaaaaau) >> 1;
}

/* Flips each bit by a hash of the bits above it: the hash of Laine and Karras (2011) with the constants of Burley. */
static uint32_t owen_scramble(uint32_t x, uint32_t seed)
{
    x = reverse_bits(x);
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return reverse_bits(x);
}

/* Second dimension of Sobol's sequence; the first is the reversed index. */
static uint32_t sobol_second(uint32_t index)
{
    uint32_t sum = 0;
    for (uint32_t direction = 1u << 31; index; index >>= 1, direction ^= direction >> 1)
        if (index & 1)
            sum ^= direction;
    return sum;
}

void weft_sequence_point(uint64_t key, uint32_t index, double point[2])
{
    uint64_t shuffle = weft_sequence_key(key, 0), scramble = weft_sequence_key(key, 1);
    uint32_t shuffled = owen_scramble(index, (uint32_t)shuffle);
    point[0] = owen_scramble(reverse_bits(shuffled), (uint32_t)scramble) * 0x1p-32;
    point[1] = owen_scramble(sobol_second(shuffled), (uint32_t)(scramble >> 32)) * 0x1p-32;
}
