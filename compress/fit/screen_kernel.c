/* The sums of compress/fit/screen.c. */
#include "compress/fit/kernels.h"

#include "base/lanes.h"

#include <string.h>

enum { PIECE = 8, EXPONENTS = WEFT_SCREEN_EXPONENTS };

WEFT_INLINE lanes of_view(const weft_strip *strip, const float *by_view, int lane)
{
    return strip->split ? lanes_of(by_view[strip->view]) : lanes_load(by_view + strip->view + lane);
}

static int end_of(const weft_strip *strip, weft_part part)
{
    return part == WEFT_PART_COARSE ? strip->coarse_slots : strip->slots;
}

double WEFT_KERNEL(weft_screen_load)(const weft_bundle *bundle, const float *cosine, const float *value,
                                     const float *table, weft_part part, weft_screen *screen)
{
    lanes total = {0};
    memset(screen->energy, 0, (size_t)bundle->view_stride * sizeof *screen->energy);
    for (int s = 0; s < bundle->strip_count; s++) {
        const weft_strip *strip = &bundle->strip[s];
        for (int lane = 0; lane < WEFT_STRIP_LANES; lane += LANES) {
            lanes t = of_view(strip, table, lane), sum = {0};
            for (int slot = 0; slot < end_of(strip, part); slot++) {
                int at = strip->first + slot * WEFT_STRIP_LANES + lane;
                lanes f = t * lanes_load(screen->model + at), k = t * lanes_load(cosine + at);
                lanes_store(screen->error + at, k * (lanes_load(value + at) - f));
                lanes_store(screen->model + at, k * f);
                lanes_store(screen->square + at, k * k);
                sum += f * f;
            }
            total += sum;
            if (strip->split)
                screen->energy[strip->view] += lanes_sum(sum);
            else
                lanes_store(screen->energy + strip->view + lane, sum);
        }
    }
    return (double)lanes_sum(total);
}

/* Sums over slots, by exponent. */
typedef struct lane_sums {
    lanes error[EXPONENTS], model[EXPONENTS], square[EXPONENTS], projected[EXPONENTS];
} lane_sums;

/* Some slots, all exponents: what is raised to them stays in registers. */
WEFT_INLINE void add_piece(const weft_bundle *bundle, const weft_screen *screen, const lanes m[3], int first, int slots,
                           lane_sums *sums)
{
    lanes power[PIECE] = {{0}};
#pragma GCC unroll 8
    for (int i = 0; i < slots; i++) {
        int at = first + i * WEFT_STRIP_LANES;
        lanes dot = lanes_load(bundle->light[0] + at) * m[0] + lanes_load(bundle->light[1] + at) * m[1] +
                    lanes_load(bundle->light[2] + at) * m[2];
        power[i] = lanes_max(dot, lanes_of(0));
    }
    for (int e = 0; e < EXPONENTS; e++) {
        lanes error = sums->error[e], model = sums->model[e], square = sums->square[e];
#pragma GCC unroll 8
        for (int i = 0; i < slots; i++) {
            int at = first + i * WEFT_STRIP_LANES;
            error += power[i] * lanes_load(screen->error + at);
            model += power[i] * lanes_load(screen->model + at);
            power[i] *= power[i];
            square += power[i] * lanes_load(screen->square + at);
            power[i] *= power[i];
        }
        sums->error[e] = error;
        sums->model[e] = model;
        sums->square[e] = square;
    }
}

/* Fewer slots than a piece, their number known to the compiler. */
WEFT_INLINE void add_rest(const weft_bundle *bundle, const weft_screen *screen, const lanes m[3], int first, int slots,
                          lane_sums *sums)
{
    if (slots >= 4) {
        add_piece(bundle, screen, m, first, 4, sums);
        first += 4 * WEFT_STRIP_LANES;
    }
    switch (slots % 4) {
    case 3:
        add_piece(bundle, screen, m, first, 3, sums);
        break;
    case 2:
        add_piece(bundle, screen, m, first, 2, sums);
        break;
    case 1:
        add_piece(bundle, screen, m, first, 1, sums);
        break;
    default:
        break;
    }
}

/* <a|f>^2 / <f|f> of views that have been summed up: a lane each, or all lanes together. */
WEFT_INLINE void project(const weft_strip *strip, int lane, const weft_screen *screen, lane_sums *sums)
{
    lanes energy = of_view(strip, screen->energy, lane);
    lanes shrink =
        lanes_where(energy > screen->negligible, 1 / lanes_select(energy > screen->negligible, energy, lanes_of(1)));
    for (int e = 0; e < EXPONENTS; e++) {
        lanes along = strip->split ? lanes_of(lanes_sum(sums->model[e])) : sums->model[e];
        lanes own = along * along * shrink;
        sums->projected[e] += strip->split ? own * (1.0f / LANES) : own;
        sums->model[e] = lanes_of(0);
    }
}

void WEFT_KERNEL(weft_screen_try)(const weft_bundle *bundle, const weft_screen *screen, const float shape[3][3],
                                  weft_part part, weft_screen_sums *result)
{
    lane_sums own = {0};
    for (int s = 0; s < bundle->strip_count; s++) {
        const weft_strip *strip = &bundle->strip[s];
        int slots = end_of(strip, part);
        for (int lane = 0; lane < WEFT_STRIP_LANES; lane += LANES) {
            lanes m[3], x = of_view(strip, bundle->view_xyz[0], lane), y = of_view(strip, bundle->view_xyz[1], lane);
            lanes z = of_view(strip, bundle->view_xyz[2], lane);
            for (int row = 0; row < 3; row++)
                m[row] = shape[row][0] * x + shape[row][1] * y + shape[row][2] * z;
            int slot = 0, first = strip->first + lane;
            for (; slot + PIECE <= slots; slot += PIECE)
                add_piece(bundle, screen, m, first + slot * WEFT_STRIP_LANES, PIECE, &own);
            add_rest(bundle, screen, m, first + slot * WEFT_STRIP_LANES, slots - slot, &own);
            if (!strip->split || lane + LANES == WEFT_STRIP_LANES)
                project(strip, lane, screen, &own);
        }
    }
    for (int e = 0; e < EXPONENTS; e++) {
        result->slope[e] = lanes_sum(own.error[e]);
        result->square[e] = lanes_sum(own.square[e]);
        result->projected[e] = lanes_sum(own.projected[e]);
    }
}
