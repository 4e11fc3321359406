/* The set of what a material stores: half floats, codes of 8, 6 and 4 bits, tables by components, frames. */
#include "bench/numerics/take.h"
#include "btf/direction/frame.h"
#include "btf/material/models.h"
#include "compress/texel/pack.h"

static numerics_value stored_half(const double *a)
{
    return scaled_value((double)weft_float_of_half(weft_half_of_float((float)a[0])), 1);
}

static numerics_value read_back(double t, int bits)
{
    return scaled_value(weft_table_of_code(weft_table_code_rounded(weft_code_of_table(t), bits)), 1);
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

/* One texel and one direction: coefficients of +-1 take the whole range of their byte. */
static numerics_value stored_components(const double *a)
{
    int direction = (int)a[0];
    int16_t mean, component[NUMERICS_COMPONENTS];
    int8_t coefficient[3 * NUMERICS_COMPONENTS] = {0};
    uint8_t table[4];
    mean = (int16_t)lround(numerics_component_mean(direction) * WEFT_BASIS_MEAN_UNIT);
    for (int k = 0; k < NUMERICS_COMPONENTS; k++) {
        double unit = WEFT_BASIS_COMPONENT_UNIT / (double)WEFT_BASIS_LARGEST_COEFFICIENT;
        component[k] = (int16_t)lround(numerics_component(k, direction) * unit);
        coefficient[3 * k] = (int8_t)lround(a[1 + k] * WEFT_BASIS_LARGEST_COEFFICIENT);
    }
    weft_table_basis basis = {.component_count = NUMERICS_COMPONENTS,
                              .direction_count = 1,
                              .texel_count = 1,
                              .mean = &mean,
                              .component = component,
                              .coefficient = coefficient};
    weft_table_basis_decode(&basis, table);
    return scaled_value(weft_table_of_code(table[0]), 1);
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
                                                   [NUMERICS_STORED_COMPONENTS] = stored_components,
                                                   [NUMERICS_STORED_NORMAL] = stored_normal}};
