#include "player/raw/format.h"

#include "base/half.h"
#include "player/raw/bc6h.h"

#include <math.h>
#include <string.h>

enum { BLOCK = WEFT_RAW_BLOCK };

const char *weft_raw_format_name(weft_raw_format format)
{
    static const char *const name[WEFT_RAW_FORMATS] = {"", "half floats", "RGB with a shared exponent", "BC6H",
                                                       "8 bits"};
    return name[format];
}

size_t weft_raw_block_bytes(weft_raw_format format)
{
    static const size_t bytes[WEFT_RAW_FORMATS] = {0, 128, 64, WEFT_BC6H_BYTES, 16};
    return bytes[format];
}

static const float *texels_of(const weft_raw_rows *rows, int x, int y)
{
    return rows->row[y] + (size_t)(x < rows->width ? x : 0) * (size_t)rows->channels * (size_t)rows->image_count;
}

/* ---- Texel by texel ---- */

static float limited(float value)
{
    return !(value > 0) ? 0 : value < 65408 ? value : 65408;
}

/* 9 bits each, exponent bias 15. Half a unit of the largest goes to its exponent where it carries that far. */
static uint32_t pack_shared_exponent(float red, float green, float blue)
{
    red = limited(red);
    green = limited(green);
    blue = limited(blue);
    float largest = fmaxf(red, fmaxf(green, blue)), scale;
    uint32_t bits, smallest_biased = 127 - 16;
    memcpy(&bits, &largest, sizeof bits);
    uint32_t biased = (bits + (1u << 14)) >> 23;
    biased = biased > smallest_biased ? biased : smallest_biased;
    bits = (2 * 127 + 8 - biased) << 23;
    memcpy(&scale, &bits, sizeof scale);
    return (biased - smallest_biased) << 27 | (uint32_t)(blue * scale + 0.5f) << 18 |
           (uint32_t)(green * scale + 0.5f) << 9 | (uint32_t)(red * scale + 0.5f);
}

/* The texel of `count` images, `stride` texels apart in the result. */
static void store_texel(weft_raw_format format, const float *texel, int image_count, int count, size_t stride,
                        void *result, size_t at)
{
    const float *red = texel, *green = texel + image_count, *blue = texel + 2 * image_count;
    for (int i = 0; i < count; i++, at += stride) {
        if (format == WEFT_RAW_EIGHT_BITS)
            ((uint8_t *)result)[at] = (uint8_t)lrintf(255 * red[i]);
        else if (format == WEFT_RAW_SHARED_EXPONENT)
            ((uint32_t *)result)[at] = pack_shared_exponent(red[i], green[i], blue[i]);
        else {
            weft_half *half = (weft_half *)result + 4 * at;
            half[0] = weft_half_of_float(red[i]);
            half[1] = weft_half_of_float(green[i]);
            half[2] = weft_half_of_float(blue[i]);
            half[3] = 0;
        }
    }
}

static void store_texels(weft_raw_format format, const weft_raw_rows *rows, int first, int count, int block_count,
                         void *result)
{
    int width = BLOCK * block_count;
    size_t stride = (size_t)width * BLOCK;
    for (int y = 0; y < BLOCK; y++) {
        for (int x = 0; x < width; x++)
            store_texel(format, texels_of(rows, x, y) + first, rows->image_count, count, stride, result,
                        (size_t)y * (size_t)width + (size_t)x);
    }
}

/* ---- Block by block ---- */

static void store_blocks(const weft_raw_rows *rows, int first, int count, int block_count, uint8_t *result)
{
    const float *texel[WEFT_BC6H_TEXELS][3];
    for (int k = 0; k < block_count; k++) {
        for (int t = 0; t < WEFT_BC6H_TEXELS; t++) {
            const float *rgb = texels_of(rows, BLOCK * k + t % BLOCK, t / BLOCK) + first;
            for (int c = 0; c < 3; c++)
                texel[t][c] = rgb + (size_t)c * (size_t)rows->image_count;
        }
        weft_bc6h_encode((const float *const(*)[3])texel, count, result + k * WEFT_BC6H_BYTES,
                         block_count * WEFT_BC6H_BYTES);
    }
}

void weft_raw_store(weft_raw_format format, const weft_raw_rows *rows, int first, int count, int block_count,
                    void *result)
{
    if (format == WEFT_RAW_BC6H)
        store_blocks(rows, first, count, block_count, result);
    else
        store_texels(format, rows, first, count, block_count, result);
}
