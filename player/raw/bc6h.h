/* Texels of three half floats in 4 x 4 blocks of 16 bytes that graphics cards decode while they filter: BC6H, unsigned
 * (GL_COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT of ARB_texture_compression_bptc; bits and arithmetic are from there). */
#ifndef WEFT_PLAYER_RAW_BC6H_H
#define WEFT_PLAYER_RAW_BC6H_H

#include <stdint.h>

enum { WEFT_BC6H_TEXELS = 16, WEFT_BC6H_BYTES = 16 };

/* texel[t][c][k] >= 0 is channel c of texel t = 4 y + x of block k; block k goes to result + k * stride. What is
 * negative or NaN becomes 0, what is over 65504 that.
 *
 * The texels of a block lie on a line between two colours, sixteen places on it (modes 11 to 14, the finest whose ends
 * are near enough). The format interpolates the bit patterns of half floats, which are nearly logarithms, so
 * distances there are relative errors; they are weighted with the largest channel of the texel, as those of dark texels
 * show less. The line begins as the principal axis and is fitted twice by least squares to the places chosen. Black,
 * and blocks of one colour, come out exact. Thread-safe. */
void weft_bc6h_encode(const float *const texel[WEFT_BC6H_TEXELS][3], int count, uint8_t *result, int stride);

#endif
