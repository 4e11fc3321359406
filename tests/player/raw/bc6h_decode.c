#include "bc6h_decode.h"

#include <stdbool.h>
#include <string.h>

/* Bits of a number in the order in which they stand in the block: `first` to `last`, up or down. */
typedef struct field {
    int end, channel, first, last;
} field;

typedef struct mode {
    int number, pattern, bits, delta_bits; /* delta_bits 0: both ends as they are */
    field field[10];
} mode;

#define LOW_TEN                                                                                                        \
    {0, 0, 0, 9}, {0, 1, 0, 9},                                                                                        \
    {                                                                                                                  \
        0, 2, 0, 9                                                                                                     \
    }

static const mode modes[] = {
    {11, 0x03, 10, 0, {LOW_TEN, {1, 0, 0, 9}, {1, 1, 0, 9}, {1, 2, 0, 9}}},
    {12,
     0x07,
     11,
     9,
     {LOW_TEN, {1, 0, 0, 8}, {0, 0, 10, 10}, {1, 1, 0, 8}, {0, 1, 10, 10}, {1, 2, 0, 8}, {0, 2, 10, 10}}},
    {13,
     0x0b,
     12,
     8,
     {LOW_TEN, {1, 0, 0, 7}, {0, 0, 11, 10}, {1, 1, 0, 7}, {0, 1, 11, 10}, {1, 2, 0, 7}, {0, 2, 11, 10}}},
    {14,
     0x0f,
     16,
     4,
     {LOW_TEN, {1, 0, 0, 3}, {0, 0, 15, 10}, {1, 1, 0, 3}, {0, 1, 15, 10}, {1, 2, 0, 3}, {0, 2, 15, 10}}},
};

static const int weight[16] = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};

static int read_bits(const uint8_t *block, int *at, int count)
{
    int value = 0;
    for (int i = 0; i < count; i++, ++*at)
        value |= (block[*at / 8] >> *at % 8 & 1) << i;
    return value;
}

static void read_field(const uint8_t *block, int *at, const field *f, int end[2][3])
{
    int step = f->first <= f->last ? 1 : -1;
    for (int bit = f->first;; bit += step) {
        end[f->end][f->channel] |= read_bits(block, at, 1) << bit;
        if (bit == f->last)
            return;
    }
}

static int unquantise(int value, int bits)
{
    if (bits >= 15 || value == 0)
        return value;
    return value == (1 << bits) - 1 ? 0xffff : ((value << 16) + 0x8000) >> bits;
}

static void read_ends(const uint8_t *block, int *at, const mode *m, int end[2][3])
{
    bool deltas = m->delta_bits > 0;
    for (int i = 0; i < (deltas ? 9 : 6); i++)
        read_field(block, at, &m->field[i], end);
    for (int c = 0; c < 3; c++) {
        if (deltas && end[1][c] >> (m->delta_bits - 1))
            end[1][c] -= 1 << m->delta_bits;
        if (deltas)
            end[1][c] = (end[0][c] + end[1][c]) & ((1 << m->bits) - 1);
        end[0][c] = unquantise(end[0][c], m->bits);
        end[1][c] = unquantise(end[1][c], m->bits);
    }
}

int bc6h_decode(const uint8_t block[16], weft_half texel[16][3])
{
    int at = 0, pattern = read_bits(block, &at, 5), end[2][3] = {{0}};
    memset(texel, 0, 16 * sizeof *texel);
    const mode *m = modes, *after = modes + sizeof modes / sizeof *modes;
    while (m < after && m->pattern != pattern)
        m++;
    if (m == after)
        return 0;
    read_ends(block, &at, m, end);
    for (int t = 0; t < 16; t++) {
        int w = weight[read_bits(block, &at, t == 0 ? 3 : 4)];
        for (int c = 0; c < 3; c++)
            texel[t][c] = (weft_half)(((end[0][c] * (64 - w) + end[1][c] * w + 32) >> 6) * 31 >> 6);
    }
    return m->number;
}
