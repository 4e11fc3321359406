/* How texels of samples are kept on the graphics card, and rows of them turned into that. Pure. */
#ifndef WEFT_PLAYER_RAW_FORMAT_H
#define WEFT_PLAYER_RAW_FORMAT_H

#include <stddef.h>
#include <stdint.h>

/* From the best to the smallest. */
typedef enum weft_raw_format {
    WEFT_RAW_FITTING,         /* the best that fits */
    WEFT_RAW_HALF,            /* half floats, 8 bytes a texel, as cards pad three of them */
    WEFT_RAW_SHARED_EXPONENT, /* 4 bytes, three mantissas of 9 bits (EXT_texture_shared_exponent) */
    WEFT_RAW_BC6H,            /* 1 byte (player/raw/bc6h.h) */
    WEFT_RAW_EIGHT_BITS,      /* 1 byte, of opacity */
    WEFT_RAW_FORMATS
} weft_raw_format;

enum { WEFT_RAW_BLOCK = 4 }; /* side of a block in texels */

/* "half floats", "RGB with a shared exponent", "BC6H", "8 bits". */
const char *weft_raw_format_name(weft_raw_format format);

/* Of a block of 4 x 4 texels. */
size_t weft_raw_block_bytes(weft_raw_format format);

/* Four rows of one level of many images; row[y][(x channels + c) image_count + i] is channel c of texel x of image i.
 * Beyond the last texel comes the first one. */
typedef struct weft_raw_rows {
    const float *row[WEFT_RAW_BLOCK];
    int width, channels, image_count;
} weft_raw_rows;

/* The images [first, first + count) of these rows, block_count blocks each: one image after the other, as OpenGL takes
 * them: four rows of texels, or one of blocks. */
void weft_raw_store(weft_raw_format format, const weft_raw_rows *rows, int first, int count, int block_count,
                    void *result);

#endif
