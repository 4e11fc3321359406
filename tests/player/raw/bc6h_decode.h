/* A decoder of BC6H blocks, unsigned, one region (modes 11 to 14), from ARB_texture_compression_bptc, which the encoder
 * and the graphics driver are held against. */
#ifndef WEFT_TESTS_PLAYER_BC6H_DECODE_H
#define WEFT_TESTS_PLAYER_BC6H_DECODE_H

#include "base/half.h"

#include <stdint.h>

/* The number of the mode; 0, and black, for one that is not decoded. */
int bc6h_decode(const uint8_t block[16], weft_half texel[16][3]);

#endif
