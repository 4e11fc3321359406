#include "player/raw/bc6h.h"

#include "base/processor.h"
#include "player/raw/bc6h_kernel.h"

#include <endian.h>
#include <string.h>

enum { TEXELS = WEFT_BC6H_TEXELS, BATCH = WEFT_BC6H_BATCH };

/* ---- Bits of a block ---- */

/* The low ten bits of one end stand together; the other end is a difference, and the bits of the first above ten follow
 * it, highest first. Without them (10-bit ends) the other end stands as it is. */
static uint64_t second_field(int end, int other, int extra_bits)
{
    if (extra_bits == 0)
        return (uint64_t)other;
    uint64_t field = (uint64_t)(other - end) & ((1u << (10 - extra_bits)) - 1);
    for (int i = 0; i < extra_bits; i++)
        field |= (uint64_t)(end >> (10 + i) & 1) << (9 - i);
    return field;
}

static void pack(const weft_bc6h_batch *batch, int k, uint8_t result[WEFT_BC6H_BYTES])
{
    int extra_bits = 6 - batch->shift[k];
    uint64_t mode = extra_bits == 0 ? 3 : extra_bits == 1 ? 7 : extra_bits == 2 ? 11 : 15;
    uint64_t second[3], low = mode, high = 0;
    for (int c = 0; c < 3; c++) {
        int end = batch->end[0][c][k];
        low |= (uint64_t)(end & 0x3ff) << (5 + 10 * c);
        second[c] = second_field(end, batch->end[1][c][k], extra_bits);
    }
    low |= second[0] << 35 | second[1] << 45 | second[2] << 55;
    high = second[2] >> 9 | (uint64_t)batch->place[0][k] << 1;
    for (int t = 1; t < TEXELS; t++)
        high |= (uint64_t)batch->place[t][k] << 4 * t;
    low = htole64(low);
    high = htole64(high);
    memcpy(result, &low, 8);
    memcpy(result + 8, &high, 8);
}

/* Fewer than a batch leave what was in its other places. */
static void load(const float *const texel[TEXELS][3], int first, int count, weft_bc6h_batch *batch)
{
    for (int t = 0; t < TEXELS; t++) {
        for (int c = 0; c < 3; c++)
            memcpy(batch->value[t][c], texel[t][c] + first, (size_t)count * sizeof(float));
    }
}

void weft_bc6h_encode(const float *const texel[TEXELS][3], int count, uint8_t *result, int stride)
{
    weft_bc6h_batch batch;
    memset(batch.value, 0, sizeof batch.value);
    for (int first = 0; first < count; first += BATCH) {
        int here = count - first < BATCH ? count - first : BATCH;
        load(texel, first, here, &batch);
        WEFT_DISPATCH(weft_bc6h_fit)(&batch);
        for (int k = 0; k < here; k++)
            pack(&batch, k, result + (size_t)(first + k) * (size_t)stride);
    }
}
