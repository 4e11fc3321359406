/* The set of what a material stores: half floats, codes of 8, 6 and 4 bits, frames. */
#include "bench/numerics/take.h"
#include "btf/direction/frame.h"
#include "compress/texel/pack.h"

static numerics_value stored_half(const double *a)
{
    return scaled_value((double)weft_float_of_half(weft_half_of_float((float)a[0])), 1);
}

/* The nearest code among 2^bits evenly spaced ones. */
static uint8_t rounded_code(uint8_t code, int bits)
{
    int steps = (1 << bits) - 1, step = (code * steps * 2 + 255) / 510;
    return (uint8_t)((step * 255 * 2 + steps) / (2 * steps));
}

static numerics_value read_back(double t, int bits)
{
    return scaled_value(weft_table_of_code(rounded_code(weft_code_of_table(t), bits)), 1);
}

static numerics_value stored_8_bits(const double *a)
{
    return read_back(a[0], 8);
}

static numerics_value stored_6_bits(const double *a)
{
    return read_back(a[0], 6);
}

static numerics_value stored_4_bits(const double *a)
{
    return read_back(a[0], 4);
}

static numerics_value stored_normal(const double *a)
{
    int16_t code[3];
    weft_frame frame = weft_frame_of_normal(take_direction(&a), 0);
    weft_frame_encode(&frame, code);
    return scaled_value(weft_frame_decode(code).normal.z, 1);
}

static bool nothing_to_begin(void)
{
    return true;
}

const numerics_set numerics_stored = {.name = "stored",
                                      .roundoff = 0x1p-53,
                                      .begin = nothing_to_begin,
                                      .function = {[NUMERICS_STORED_HALF] = stored_half,
                                                   [NUMERICS_STORED_8_BITS] = stored_8_bits,
                                                   [NUMERICS_STORED_6_BITS] = stored_6_bits,
                                                   [NUMERICS_STORED_4_BITS] = stored_4_bits,
                                                   [NUMERICS_STORED_NORMAL] = stored_normal}};
