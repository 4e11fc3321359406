/* The passes over the samples; see compress/fit/normal.h. */
#include "compress/fit/kernels.h"

#include "base/lanes.h"

#include <string.h>

enum {
    PIECE = 27,                     /* slots whose columns stay in the first cache */
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

/* What the columns of the lobes are made of at one sample. */
typedef struct lobe_lanes {
    lanes b[WEFT_GRAM_LOBES], log2_b[WEFT_GRAM_LOBES], h[WEFT_GRAM_LOBES]; /* h = k b^(N - 1), 0 where b <= 0 */
} lobe_lanes;

WEFT_INLINE lobe_lanes lobes_at(const lanes l[3], lanes k, const weft_gram_point *point, int lobe_count,
                                const strip_lanes *own)
{
    lobe_lanes at;
    lanes dot[WEFT_GRAM_LOBES], base[WEFT_GRAM_LOBES], power[WEFT_GRAM_LOBES];
    WEFT_EACH (lobe_count)
        dot[i] = l[0] * own->m[i][0] + l[1] * own->m[i][1] + l[2] * own->m[i][2];
    WEFT_EACH (lobe_count)
        base[i] = lanes_select(dot[i] > LEAST_BASE, dot[i], lanes_of(LEAST_BASE));
    lanes_log2_each(lobe_count, base, at.log2_b);
    WEFT_EACH (lobe_count)
        power[i] = (point->exponent[i] - 1) * at.log2_b[i];
    lanes_exp2_each(lobe_count, power, power);
    WEFT_EACH (lobe_count) {
        at.b[i] = lanes_where(dot[i] > LEAST_BASE, dot[i]);
        at.h[i] = lanes_where(dot[i] > LEAST_BASE, k * power[i]);
    }
    return at;
}

/* Columns of one slot. */
WEFT_INLINE void write_columns(const weft_bundle *bundle, const float *cosine, const float *value,
                               const weft_gram_point *point, int lobe_count, const strip_lanes *own, int sample,
                               int slot, lanes columns[LAST][PIECE])
{
    const lanes l[3] = {lanes_load(bundle->light[0] + sample), lanes_load(bundle->light[1] + sample),
                        lanes_load(bundle->light[2] + sample)};
    lanes k = lanes_load(cosine + sample), f = k * point->diffuse;
    columns[0][slot] = k;
    const lobe_lanes at = lobes_at(l, k, point, lobe_count, own);
    WEFT_EACH (lobe_count) {
        lanes g = at.h[i] * at.b[i];
        f += point->amplitude[i] * g;
        for (int axis = 0; axis < 3; axis++)
            columns[1 + 4 * i + axis][slot] = at.h[i] * l[axis];
        columns[4 + 4 * i][slot] = g * at.log2_b[i];
    }
    columns[1 + 4 * lobe_count][slot] = lanes_load(value + sample) - own->table * f;
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
                *to = (lane ? *to : 0) + lanes_sum(*from);
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
            memset(own_sums, 0, (size_t)products * sizeof *own_sums);
            for (int first = 0; first < end; first += PIECE) {
                int piece = end - first < PIECE ? end - first : PIECE;
                for (int slot = 0; slot < piece; slot++)
                    write_columns(bundle, cosine, value, point, lobe_count, &own,
                                  strip->first + (first + slot) * WEFT_STRIP_LANES + lane, slot, columns);
                add_products(columns, piece, count, own_sums);
            }
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
            for (int slot = 0; slot < end; slot++) {
                int sample = strip->first + slot * WEFT_STRIP_LANES + lane;
                const lanes l[3] = {lanes_load(bundle->light[0] + sample), lanes_load(bundle->light[1] + sample),
                                    lanes_load(bundle->light[2] + sample)};
                lanes k = lanes_load(cosine + sample), f = k * point->diffuse;
                const lobe_lanes at = lobes_at(l, k, point, point->lobe_count, &own);
                for (int i = 0; i < point->lobe_count; i++)
                    f += point->amplitude[i] * at.h[i] * at.b[i];
                lanes_store(result + sample, f);
            }
        }
    }
}
