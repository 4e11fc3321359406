#include "compress/gram.h"

#include "btf/real.h"

#include <string.h>

typedef float lanes __attribute__((vector_size(4 * WEFT_LANES)));
typedef int32_t lane_bits __attribute__((vector_size(4 * WEFT_LANES)));

#define INLINED static inline __attribute__((always_inline))

enum { PIECE = 128, BLOCK = 4 }; /* samples whose columns stay in the first cache; columns of a register block */

#define LN2 0.69314718055994530942

/* log2 of positive normal floats: the mantissa m in [sqrt(1/2), sqrt(2)) through atanh((m - 1) / (m + 1)). Relative
 * error below 2e-7 also near 1, which high exponents need. */
INLINED lanes lanes_log2(lanes x)
{
    lane_bits bits = (lane_bits)x;
    lane_bits exponent = (bits - 0x3f3504f3) >> 23;
    lanes m = (lanes)(bits - (exponent << 23));
    lanes s = (m - 1) / (m + 1);
    lanes s2 = s * s;
    lanes series = 1 + s2 * (1.0f / 3 + s2 * (1.0f / 5 + s2 * (1.0f / 7 + s2 * (1.0f / 9))));
    return __builtin_convertvector(exponent, lanes) + (float)(2 / LN2) * s * series;
}

/* 2^x for x <= 0, flushed to 2^-126 below: split into an integer power and the Taylor series of the rest. */
INLINED lanes lanes_exp2(lanes x)
{
    lane_bits low = x < -126.0f;
    x = (lanes)(((lane_bits)x & ~low) | ((lane_bits)(x * 0 - 126.0f) & low));
    lane_bits biased = __builtin_convertvector(x + 127.5f, lane_bits);
    lanes f = (x + 127 - __builtin_convertvector(biased, lanes)) * (float)LN2;
    lanes series =
        1 + f * (1 + f * (1.0f / 2 + f * (1.0f / 6 + f * (1.0f / 24 + f * (1.0f / 120 + f * (1.0f / 720))))));
    return series * (lanes)(biased << 23);
}

INLINED lanes lanes_load(const float *from)
{
    return *(const lanes *)__builtin_assume_aligned(from, 4 * WEFT_LANES);
}

INLINED void lanes_store(float *to, lanes x)
{
    *(lanes *)__builtin_assume_aligned(to, 4 * WEFT_LANES) = x;
}

/* Sums of neighbours, those of a in the lower half and those of b in the upper. */
INLINED lanes lanes_pair_sums(lanes a, lanes b)
{
    return __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30) +
           __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
}

/* The sums of sixteen vectors, in their order, by halving four times. Overwrites them. */
INLINED lanes lanes_sums(lanes x[WEFT_LANES])
{
    for (int count = WEFT_LANES / 2; count > 0; count /= 2) {
        for (int i = 0; i < count; i++)
            x[i] = lanes_pair_sums(x[2 * i], x[2 * i + 1]);
    }
    return x[0];
}

/* k b^(N - 1) for m = M v, and b and log2 b; 0 where b <= 0. */
INLINED lanes lobe_column(lanes lx, lanes ly, lanes lz, lanes k, const float m[3], float exponent, lanes *b,
                          lanes *log2_b)
{
    lanes dot = lx * m[0] + ly * m[1] + lz * m[2];
    lane_bits positive = dot > 1e-30f;
    *b = (lanes)((lane_bits)dot & positive);
    *log2_b = lanes_log2((lanes)(((lane_bits)dot & positive) | ((lane_bits)(dot * 0 + 1e-30f) & ~positive)));
    return (lanes)((lane_bits)(k * lanes_exp2((exponent - 1) * *log2_b)) & positive);
}

/* M_i v for every lobe. */
INLINED void shape_times_view(const weft_gram_point *point, weft_vec3 view, float m[WEFT_GRAM_LOBES][3])
{
    for (int i = 0; i < point->lobe_count; i++) {
        for (int row = 0; row < 3; row++)
            m[i][row] = point->shape[i][row][0] * (float)view.x + point->shape[i][row][1] * (float)view.y +
                        point->shape[i][row][2] * (float)view.z;
    }
}

/* Columns of the samples [first, first + count) of one view. */
INLINED void write_columns(const weft_bundle *bundle, const float *cosine, const float *value,
                           const weft_gram_point *point, int lobe_count, float m[WEFT_GRAM_LOBES][3], float table,
                           int first, int count, float columns[WEFT_GRAM_STRIDE][PIECE])
{
    for (int lane = 0; lane < count; lane += WEFT_LANES) {
        lanes lx = lanes_load(bundle->light[0] + first + lane);
        lanes ly = lanes_load(bundle->light[1] + first + lane);
        lanes lz = lanes_load(bundle->light[2] + first + lane);
        lanes k = lanes_load(cosine + first + lane);
        lanes f = k * point->diffuse;
        lanes_store(columns[0] + lane, k);
        for (int i = 0; i < lobe_count; i++) {
            lanes b, log2_b;
            lanes h = lobe_column(lx, ly, lz, k, m[i], point->exponent[i], &b, &log2_b);
            lanes g = h * b;
            f += point->amplitude[i] * g;
            lanes_store(columns[1 + 4 * i] + lane, h * lx);
            lanes_store(columns[2 + 4 * i] + lane, h * ly);
            lanes_store(columns[3 + 4 * i] + lane, h * lz);
            lanes_store(columns[4 + 4 * i] + lane, g * log2_b);
        }
        lanes_store(columns[1 + 4 * lobe_count] + lane, lanes_load(value + first + lane) - table * f);
    }
}

/* Adds the products of the columns a..a+3 with b..b+3, sixteen sums that fit the registers. */
INLINED void add_block(float columns[WEFT_GRAM_STRIDE][PIECE], int a, int b, int count, float *sums)
{
    lanes sum[BLOCK * BLOCK] = {0};
    for (int lane = 0; lane < count; lane += WEFT_LANES) {
        lanes right[BLOCK];
        for (int j = 0; j < BLOCK; j++)
            right[j] = lanes_load(columns[b + j] + lane);
        for (int i = 0; i < BLOCK; i++) {
            lanes left = lanes_load(columns[a + i] + lane);
            for (int j = 0; j < BLOCK; j++)
                sum[BLOCK * i + j] += left * right[j];
        }
    }
    lanes total = lanes_sums(sum);
    for (int i = 0; i < BLOCK; i++) {
        for (int j = 0; j < BLOCK; j++)
            sums[(a + i) * WEFT_GRAM_STRIDE + b + j] += total[BLOCK * i + j];
    }
}

/* One lobe count at a time, so that the compiler unrolls everything inside. */
INLINED void accumulate(const weft_bundle *bundle, const float *cosine, const float *value,
                        const weft_gram_point *point, int lobe_count, const float *table, bool coarse, float *sums)
{
    _Alignas(64) float columns[WEFT_GRAM_STRIDE][PIECE];
    memset(columns, 0, sizeof columns);
    int used = (weft_gram_columns(lobe_count) + BLOCK - 1) / BLOCK * BLOCK;
    for (int view = 0; view < bundle->view_count; view++) {
        float *own = sums + (size_t)view * WEFT_GRAM_STRIDE * WEFT_GRAM_STRIDE;
        memset(own, 0, WEFT_GRAM_STRIDE * WEFT_GRAM_STRIDE * sizeof *own);
        int end = coarse ? bundle->coarse_end[view] : bundle->first_lane[view + 1];
        float m[WEFT_GRAM_LOBES][3];
        shape_times_view(point, bundle->view[view], m);
        for (int first = bundle->first_lane[view]; first < end; first += PIECE) {
            int count = end - first < PIECE ? end - first : PIECE;
            write_columns(bundle, cosine, value, point, lobe_count, m, table[view], first, count, columns);
            for (int a = 0; a < used; a += BLOCK) {
                for (int b = a; b < used; b += BLOCK)
                    add_block(columns, a, b, count, own);
            }
        }
        for (int i = 0; i < used; i++) {
            for (int j = 0; j < i; j++)
                own[i * WEFT_GRAM_STRIDE + j] = own[j * WEFT_GRAM_STRIDE + i];
        }
    }
}

WEFT_HOT void weft_gram_accumulate(const weft_bundle *bundle, const float *cosine, const float *value,
                                   const weft_gram_point *point, const float *table, bool coarse, float *sums)
{
    switch (point->lobe_count) {
    case 0:
        accumulate(bundle, cosine, value, point, 0, table, coarse, sums);
        break;
    case 1:
        accumulate(bundle, cosine, value, point, 1, table, coarse, sums);
        break;
    case 2:
        accumulate(bundle, cosine, value, point, 2, table, coarse, sums);
        break;
    default:
        accumulate(bundle, cosine, value, point, 3, table, coarse, sums);
        break;
    }
}

WEFT_HOT void weft_gram_evaluate(const weft_bundle *bundle, const float *cosine, const weft_gram_point *point,
                                 float *result)
{
    for (int view = 0; view < bundle->view_count; view++) {
        float m[WEFT_GRAM_LOBES][3];
        shape_times_view(point, bundle->view[view], m);
        for (int lane = bundle->first_lane[view]; lane < bundle->first_lane[view + 1]; lane += WEFT_LANES) {
            lanes k = lanes_load(cosine + lane);
            lanes f = k * point->diffuse;
            for (int i = 0; i < point->lobe_count; i++) {
                lanes b, log2_b;
                lanes h = lobe_column(lanes_load(bundle->light[0] + lane), lanes_load(bundle->light[1] + lane),
                                      lanes_load(bundle->light[2] + lane), k, m[i], point->exponent[i], &b, &log2_b);
                f += point->amplitude[i] * h * b;
            }
            lanes_store(result + lane, f);
        }
    }
}
