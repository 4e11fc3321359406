/* The passes over the samples; see compress/fit/normal.h. */
#include "compress/fit/kernels.h"

#include "base/lanes.h"

#include <string.h>

enum {
    STEP = 2,                       /* slots whose powers are found in step */
    PIECE = 28,                     /* slots whose columns stay in the first cache */
    TILE = LANES == 8 ? 3 : 5,      /* TILE x TILE sums stay in registers: AVX2 has half as many as AVX-512 and NEON */
    LAST = WEFT_GRAM_COLUMNS + TILE /* columns are read by whole tiles */
};

#define LEAST_BASE 1e-30f /* of a power; lobes are black below */

/* What the lanes of a strip have in common over its slots. */
typedef struct strip_lanes {
    lanes m[WEFT_GRAM_LOBES][3]; /* M_i v */
    lanes table;
} strip_lanes;

WEFT_INLINE lanes of_view(const weft_strip *strip, const float *by_view, int lane)
{
    return strip->split ? lanes_of(by_view[strip->view]) : lanes_load(by_view + strip->view + lane);
}

WEFT_INLINE strip_lanes lanes_of_strip(const weft_bundle *bundle, const weft_strip *strip, const weft_gram_point *point,
                                       int lobe_count, const float *table, int lane)
{
    strip_lanes own = {.table = table ? of_view(strip, table, lane) : lanes_of(0)};
    lanes x = of_view(strip, bundle->view_xyz[0], lane), y = of_view(strip, bundle->view_xyz[1], lane);
    lanes z = of_view(strip, bundle->view_xyz[2], lane);
    for (int i = 0; i < lobe_count; i++) {
        for (int row = 0; row < 3; row++)
            own.m[i][row] = point->shape[i][row][0] * x + point->shape[i][row][1] * y + point->shape[i][row][2] * z;
    }
    return own;
}

/* What the columns of a lobe are made of at some samples. */
typedef struct lobe_lanes {
    lanes b[STEP], log2_b[STEP], h[STEP]; /* at least LEAST_BASE; h = k b^(N - 1), 0 where l . M v is less */
} lobe_lanes;

WEFT_INLINE lobe_lanes lobe_at(lanes light[STEP][3], const lanes k[STEP], const lanes m[3], float exponent)
{
    lobe_lanes at;
    lanes dot[STEP], power[STEP];
    WEFT_EACH (STEP) {
        dot[i] = light[i][0] * m[0] + light[i][1] * m[1] + light[i][2] * m[2];
        at.b[i] = lanes_max(dot[i], lanes_of(LEAST_BASE));
    }
    lanes_log2_each(STEP, at.b, at.log2_b);
    WEFT_EACH (STEP)
        power[i] = (exponent - 1) * at.log2_b[i];
    lanes_exp2_each(STEP, power, power);
    WEFT_EACH (STEP)
        at.h[i] = lanes_where(dot[i] > LEAST_BASE, k[i] * power[i]);
    return at;
}

WEFT_INLINE void load_light(const weft_bundle *bundle, int sample, lanes light[STEP][3])
{
    WEFT_EACH (STEP) {
        for (int axis = 0; axis < 3; axis++)
            light[i][axis] = lanes_load(bundle->light[axis] + sample + i * WEFT_STRIP_LANES);
    }
}

/* The columns of lobe number `lobe` in some slots, and its share of e. A lobe at a time, and STEP slots in step: all
 * that a slot needs stays in registers. The last slot may be one too many. */
WEFT_INLINE void write_lobe(const weft_bundle *bundle, const weft_gram_point *point, int lobe, const strip_lanes *own,
                            int first, int slots, lanes columns[LAST][PIECE], lanes *error)
{
    const lanes m[3] = {own->m[lobe][0], own->m[lobe][1], own->m[lobe][2]};
    const lanes strength = own->table * point->amplitude[lobe];
    const float exponent = point->exponent[lobe];
    lanes(*column)[PIECE] = columns + 1 + 4 * lobe;
    for (int slot = 0; slot < slots; slot += STEP) {
        lanes light[STEP][3], k[STEP];
        load_light(bundle, first + slot * WEFT_STRIP_LANES, light);
        WEFT_EACH (STEP)
            k[i] = columns[0][slot + i];
        const lobe_lanes at = lobe_at(light, k, m, exponent);
        WEFT_EACH (STEP) {
            lanes g = at.h[i] * at.b[i];
            for (int axis = 0; axis < 3; axis++)
                column[axis][slot + i] = at.h[i] * light[i][axis];
            column[3][slot + i] = g * at.log2_b[i];
            error[slot + i] -= strength * g;
        }
    }
}

/* The columns of some slots from sample `first` on. */
WEFT_INLINE void write_columns(const weft_bundle *bundle, const float *cosine, const float *value,
                               const weft_gram_point *point, int lobe_count, const strip_lanes *own, int first,
                               int slots, lanes columns[LAST][PIECE])
{
    lanes *error = columns[1 + 4 * lobe_count];
    const lanes diffuse = own->table * point->diffuse;
    for (int slot = 0; slot < slots; slot++) {
        int sample = first + slot * WEFT_STRIP_LANES;
        columns[0][slot] = lanes_load(cosine + sample);
        error[slot] = lanes_load(value + sample) - diffuse * columns[0][slot];
    }
    WEFT_EACH (lobe_count)
        write_lobe(bundle, point, i, own, first, slots, columns, error);
}

/* <h_i l_a | h_j l_b> = <h_i l_b | h_j l_a>: the product of columns p < q of two lobes is that of two others which are
 * summed anyway. Swaps the axes then. */
WEFT_INLINE bool swap_axes(int *p, int *q)
{
    int lobe_p = (*p - 1) / 4, lobe_q = (*q - 1) / 4, axis_p = (*p - 1) % 4, axis_q = (*q - 1) % 4;
    if (*p == 0 || lobe_p == lobe_q || axis_p == 3 || axis_q == 3 || axis_p <= axis_q)
        return false;
    *p = 1 + 4 * lobe_p + axis_q;
    *q = 1 + 4 * lobe_q + axis_p;
    return true;
}

/* Is the product of columns p and q one to be summed? e, the last of `count`, is no column of a lobe. */
WEFT_INLINE bool is_summed(int p, int q, int count)
{
    return p <= q && q < count && (q == count - 1 || !swap_axes(&p, &q));
}

/* Adds the products of the columns from a with those from b, as many sums as fit the registers. */
WEFT_INLINE void add_tile(lanes columns[LAST][PIECE], int slots, int a, int b, int count, lanes *sums)
{
    lanes sum[TILE][TILE] = {{{0}}};
    for (int slot = 0; slot < slots; slot++) {
        lanes right[TILE];
#pragma GCC unroll 8
        for (int j = 0; j < TILE; j++)
            right[j] = columns[b + j][slot];
#pragma GCC unroll 8
        for (int i = 0; i < TILE; i++) {
            lanes left = columns[a + i][slot];
#pragma GCC unroll 8
            for (int j = 0; j < TILE; j++) {
                if (is_summed(a + i, b + j, count))
                    sum[i][j] += left * right[j];
            }
        }
    }
#pragma GCC unroll 8
    for (int i = 0; i < TILE; i++) {
#pragma GCC unroll 8
        for (int j = 0; j < TILE; j++) {
            if (is_summed(a + i, b + j, count))
                sums[weft_gram_product(a + i, b + j, count)] += sum[i][j];
        }
    }
}

/* All products of the first `count` columns. */
WEFT_INLINE void add_products(lanes columns[LAST][PIECE], int slots, int count, lanes *sums)
{
#pragma GCC unroll 8
    for (int a = 0; a < count; a += TILE) {
        add_tile(columns, slots, a, a, count, sums);
#pragma GCC unroll 8
        for (int b = a + TILE; b < count; b += TILE)
            add_tile(columns, slots, a, b, count, sums);
    }
}

WEFT_INLINE void store_sums(const weft_strip *strip, int lane, const lanes *own, int count, int stride, float *sums)
{
#pragma GCC unroll 16
    for (int a = 0; a < count; a++) {
#pragma GCC unroll 16
        for (int b = a; b < count; b++) {
            int p = a, q = b;
            if (b < count - 1)
                swap_axes(&p, &q);
            const lanes *from = own + weft_gram_product(p, q, count);
            float *to = sums + (size_t)weft_gram_product(a, b, count) * (size_t)stride + strip->view;
            if (strip->split)
                *to = lanes_sum(*from);
            else
                lanes_store(to + lane, *from);
        }
    }
}

/* One lobe count at a time, so that the compiler unrolls everything inside. */
WEFT_INLINE void accumulate(const weft_bundle *bundle, const float *cosine, const float *value,
                            const weft_gram_point *point, int lobe_count, const float *table, weft_part part,
                            float *sums)
{
    lanes columns[LAST][PIECE], own_sums[WEFT_GRAM_PRODUCTS];
    int count = weft_gram_columns(lobe_count), products = count * (count + 1) / 2;
    memset(columns[count], 0, TILE * sizeof columns[0]);
    for (int s = 0; s < bundle->strip_count; s++) {
        const weft_strip *strip = &bundle->strip[s];
        int end = part == WEFT_PART_COARSE ? strip->coarse_slots : strip->slots;
        for (int lane = 0; lane < WEFT_STRIP_LANES; lane += LANES) {
            strip_lanes own = lanes_of_strip(bundle, strip, point, lobe_count, table, lane);
            if (!strip->split || lane == 0)
                memset(own_sums, 0, (size_t)products * sizeof *own_sums);
            for (int first = 0; first < end; first += PIECE) {
                int piece = end - first < PIECE ? end - first : PIECE;
                write_columns(bundle, cosine, value, point, lobe_count, &own,
                              strip->first + first * WEFT_STRIP_LANES + lane, piece, columns);
                add_products(columns, piece, count, own_sums);
            }
            if (!strip->split || lane + LANES == WEFT_STRIP_LANES)
                store_sums(strip, lane, own_sums, count, bundle->view_stride, sums);
        }
    }
}

void WEFT_KERNEL(weft_gram_accumulate)(const weft_bundle *bundle, const float *cosine, const float *value,
                                       const weft_gram_point *point, const float *table, weft_part part, float *sums)
{
    switch (point->lobe_count) {
    case 0:
        accumulate(bundle, cosine, value, point, 0, table, part, sums);
        break;
    case 1:
        accumulate(bundle, cosine, value, point, 1, table, part, sums);
        break;
    case 2:
        accumulate(bundle, cosine, value, point, 2, table, part, sums);
        break;
    default:
        accumulate(bundle, cosine, value, point, 3, table, part, sums);
        break;
    }
}

void WEFT_KERNEL(weft_gram_evaluate)(const weft_bundle *bundle, const float *cosine, const weft_gram_point *point,
                                     weft_part part, float *result)
{
    for (int s = 0; s < bundle->strip_count; s++) {
        const weft_strip *strip = &bundle->strip[s];
        for (int lane = 0; lane < WEFT_STRIP_LANES; lane += LANES) {
            strip_lanes own = lanes_of_strip(bundle, strip, point, point->lobe_count, NULL, lane);
            int end = part == WEFT_PART_COARSE ? strip->coarse_slots : strip->slots;
            for (int slot = 0; slot < end; slot += STEP) {
                int sample = strip->first + slot * WEFT_STRIP_LANES + lane;
                lanes light[STEP][3], k[STEP], f[STEP];
                load_light(bundle, sample, light);
                WEFT_EACH (STEP) {
                    k[i] = lanes_load(cosine + sample + i * WEFT_STRIP_LANES);
                    f[i] = k[i] * point->diffuse;
                }
                for (int lobe = 0; lobe < point->lobe_count; lobe++) {
                    const lobe_lanes at = lobe_at(light, k, own.m[lobe], point->exponent[lobe]);
                    WEFT_EACH (STEP)
                        f[i] += point->amplitude[lobe] * at.h[i] * at.b[i];
                }
                for (int i = 0; i < STEP && slot + i < end; i++)
                    lanes_store(result + sample + i * WEFT_STRIP_LANES, f[i]);
            }
        }
    }
}
