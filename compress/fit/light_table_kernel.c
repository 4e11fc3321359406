/* T and S of a given model, in turn: see compress/fit/light_table.h. A view a lane; a light a row. */
#include "base/lanes.h"
#include "compress/fit/kernels.h"

WEFT_DECLARE_FIT_KERNELS(WEFT_INSTRUCTION_SET);

/* Less than this of a model, and the square of what makes up for it could overflow. */
#define LEAST_SQUARE 1e-30f

/* max(0, product / square), 1 where the square is nothing. */
WEFT_INLINE lanes quotient(lanes product, lanes square)
{
    lane_bits seen = square > LEAST_SQUARE;
    return lanes_select(seen, lanes_max(product / lanes_select(seen, square, lanes_of(1)), lanes_of(0)), lanes_of(1));
}

/* T of the views of one vector: sum_l S <f|r> / sum_l S^2 <f|f>. */
WEFT_INLINE lanes table_of(const weft_separable *own, const float *light, int view)
{
    lanes product = {0}, square = {0};
    for (int l = 0; l < own->light_count; l++) {
        lanes s = lanes_of(light[l]);
        product += s * lanes_load(own->product + l * own->view_stride + view);
        square += s * s * lanes_load(own->square + l * own->view_stride + view);
    }
    return quotient(product, square);
}

/* The sums of S over the views: light [light_count] <T f|r>, energy alike <T f|T f>. */
WEFT_INLINE void sum_lights(const weft_separable *own, const float *table, float *light, float *energy)
{
    for (int l = 0; l < own->light_count; l++) {
        const float *product_row = own->product + l * own->view_stride;
        const float *square_row = own->square + l * own->view_stride;
        lanes product = {0}, square = {0};
        for (int view = 0; view < own->view_stride; view += LANES) {
            lanes t = lanes_load(table + view);
            product += t * lanes_load(product_row + view);
            square += t * t * lanes_load(square_row + view);
        }
        light[l] = lanes_sum(product);
        energy[l] = lanes_sum(square);
    }
}

void WEFT_KERNEL(weft_light_separate)(const weft_separable *own, bool with_table, int rounds, float *table,
                                      float *light, float *energy)
{
    for (int round = 0; round < rounds; round++) {
        for (int view = 0; with_table && view < own->view_stride; view += LANES)
            lanes_store(table + view, table_of(own, light, view));
        sum_lights(own, table, light, energy);
        float total = 0;
        for (int l = 0; l < own->light_count; l++)
            total += energy[l];
        float prior = own->prior * total / (float)own->light_count;
        for (int l = 0; l < own->light_count; l++)
            light[l] = energy[l] + prior > 0 ? fmaxf(0, light[l] + prior) / (energy[l] + prior) : 1;
    }
}
