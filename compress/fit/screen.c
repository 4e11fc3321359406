/* Which lobe would help a fit most: all lobes of a grid of shapes and exponents, tried at once to first order.
 *
 * For a lobe a(l, v) = k b^N that is added to a model f with amplitude x >= 0, T(v) eliminated in every view, the
 * residual falls to first order by g^2 / h with
 *     g = sum_v T <a | r - T f>,    h = sum_v T^2 (<a|a> - <a|f>^2 / <f|f>), without T: sum_v <a|a>.
 * Exponents are the powers of four: each is the square of the square of the one before, and the square between them is
 * what <a|a> takes. So a lobe costs five operations a sample, no power and no table, in any frame and for any
 * directions.
 *
 * A fit grows lobe by lobe, each found so and then moved with all others (Boyd, Schiebinger and Recht 2017: alternating
 * descent conditional gradient). */
#include "compress/fit/workspace.h"

#include "base/integers.h"

#include <math.h>

/* This part of <a|a> is never taken for what the model has already: single precision cannot tell. */
#define COLLINEAR 1e-4
#define LN_4 1.3862943611198906

enum { SHAPES = 21 };

/* Every shape has each component 0, 1 or -1. The others of that kind are dark for all lights and views, or nearly. */
static const signed char shape[SHAPES][3] = {
    {0, 0, 1},  {1, 0, 1},   {-1, 0, 1},  {0, 1, 1},  {0, -1, 1},  {1, 1, 1},   {-1, 1, 1},
    {1, -1, 1}, {-1, -1, 1}, {1, 0, 0},   {-1, 0, 0}, {0, 1, 0},   {0, -1, 0},  {1, 1, 0},
    {-1, 1, 0}, {1, -1, 0},  {-1, -1, 0}, {1, 1, -1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, -1},
};

/* Lobes found so far, the best first. */
typedef struct ranking {
    int count, most;
    weft_fit_lobe *lobe;
    double gain[SHAPES];
} ranking;

static void rank(ranking *own, const weft_fit_lobe *lobe, double gain)
{
    int at = own->count;
    while (at > 0 && own->gain[at - 1] < gain)
        at--;
    if (at == own->most)
        return;
    own->count = weft_smaller(own->count + 1, own->most);
    for (int i = own->count - 1; i > at; i--) {
        own->gain[i] = own->gain[i - 1];
        own->lobe[i] = own->lobe[i - 1];
    }
    own->gain[at] = gain;
    own->lobe[at] = *lobe;
}

/* The best exponent of a shape. */
static double best_exponent(const weft_screen_sums *sums, const weft_fit_options *options, weft_fit_lobe *lobe)
{
    double best = 0;
    for (int e = 0; e < WEFT_SCREEN_EXPONENTS && e * LN_4 <= log(options->max_exponent); e++) {
        double slope = (double)sums->slope[e], square = (double)sums->square[e];
        double curvature = fmax(0, square - (double)sums->projected[e]) + COLLINEAR * square;
        double gain = slope > 0 && curvature > 0 ? slope * slope / curvature : 0;
        if (gain > best) {
            best = gain;
            lobe->log_exponent = e * LN_4;
            lobe->amplitude = fmin(options->max_amplitude, slope / curvature);
        }
    }
    return best;
}

int weft_screen_run(const weft_bundle *bundle, const weft_samples *samples, int channel,
                    const weft_fit_options *options, weft_fit_workspace *workspace, const weft_trial *trial, int most,
                    weft_fit_lobe *lobe)
{
    weft_part part = WEFT_PART_COARSE;
    weft_screen *screen = &workspace->screen;
    weft_gram_point point = weft_gram_point_of_fit(&trial->fit);
    ranking own = {.most = weft_smaller(most, SHAPES), .lobe = lobe};
    WEFT_DISPATCH(weft_gram_evaluate)(bundle, samples->cosine, &point, part, screen->model);
    double energy =
        WEFT_DISPATCH(weft_screen_load)(bundle, samples->cosine, samples->value[channel], trial->table, part, screen);
    screen->negligible = options->table ? (float)(1e-9 * energy / bundle->view_count) : INFINITY;
    for (int i = 0; i < SHAPES; i++) {
        weft_fit one = {.lobe_count = 1, .frame = trial->fit.frame};
        for (int k = 0; k < 3; k++)
            one.lobe[0].c[k] = shape[i][k];
        point = weft_gram_point_of_fit(&one);
        weft_screen_sums sums;
        WEFT_DISPATCH(weft_screen_try)(bundle, screen, (const float(*)[3])point.shape[0], part, &sums);
        double gain = best_exponent(&sums, options, &one.lobe[0]);
        if (gain > 0)
            rank(&own, &one.lobe[0], gain);
    }
    return own.count;
}
