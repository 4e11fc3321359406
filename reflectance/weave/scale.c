/* The constant s of a weave: 1/s = (1/pi) times the integral of its specular part against both cosines, a
 * five-dimensional quadrature (two directions and the coordinate along or round the yarn) over an additive recurrence.
 */
#include "reflectance/weave/direction_sequence.h"
#include "reflectance/weave/syntax.h"
#include "reflectance/weave/weave.h"

enum { DIMENSIONS = 5, BLOCK_POINTS = 4096, MAX_BLOCKS = 256, MIN_BLOCKS = 1, BUDGET_BLOCKS = 1024 };

/* One segment and the share of the cloth that looks like it. */
typedef struct kind_of_yarn {
    const weft_prepared_segment *prepared;
    double share; /* sum of F aw */
} kind_of_yarn;

/* ---- Turning: sines and cosines of evenly spaced angles ---- */

typedef struct turn {
    double sine, cosine;
} turn;

static turn turn_by(double radians)
{
    return (turn){sin(radians), cos(radians)};
}

static turn turned(turn from, turn by)
{
    return (turn){from.sine * by.cosine + from.cosine * by.sine, from.cosine * by.cosine - from.sine * by.sine};
}

/* A direction with the density cos(theta) / pi; r uniform in [0, 1). */
static weft_vec3 cosine_weighted_at(double r, turn azimuth)
{
    double radius = sqrt(r);
    return weft_vec3_of((weft_real)(radius * azimuth.cosine), (weft_real)(radius * azimuth.sine),
                        (weft_real)sqrt(1 - r));
}

/* ---- Quadrature ---- */

/* The recurrence moves all angles by the same steps: rounding grows over a block only, to some 1e-13. */
static double block_sum(const weft_prepared_segment *prepared, const double step[DIMENSIONS], int block)
{
    const double round = 2 * (double)WEFT_PI;
    double limit = prepared->filament ? (double)WEFT_PI / 2 : (double)prepared->spine.umax, sum = 0;
    double place = recurrence_at(step[4], block * BLOCK_POINTS);
    turn light = turn_by(round * recurrence_at(step[1], block * BLOCK_POINTS)), light_step = turn_by(round * step[1]);
    turn view = turn_by(round * recurrence_at(step[3], block * BLOCK_POINTS)), view_step = turn_by(round * step[3]);
    turn along = turn_by((2 * place - 1) * limit);
    turn onward = turn_by(2 * limit * step[4]), back = turn_by(2 * limit * (step[4] - 1));
    for (int k = block * BLOCK_POINTS + 1; k <= (block + 1) * BLOCK_POINTS; k++) {
        double before = place;
        place = recurrence_at(step[4], k);
        light = turned(light, light_step);
        view = turned(view, view_step);
        along = turned(along, place < before ? back : onward);
        weft_angle at = {(weft_real)((2 * place - 1) * limit), (weft_real)along.sine, (weft_real)along.cosine};
        sum += weft_prepared_integrand(prepared, at, cosine_weighted_at(recurrence_at(step[0], k), light),
                                       cosine_weighted_at(recurrence_at(step[2], k), view));
    }
    return sum * 2 * limit;
}

/* Mean of f_s over cosine-weighted pairs of directions. */
static double mean_reflectance(const weft_prepared_segment *prepared, int blocks)
{
    double step[DIMENSIONS], partial[MAX_BLOCKS], sum = 0;
    recurrence_steps(DIMENSIONS, step);
#pragma omp parallel for schedule(dynamic)
    for (int block = 0; block < blocks; block++)
        partial[block] = block_sum(prepared, step, block);
    for (int block = 0; block < blocks; block++)
        sum += partial[block];
    return sum / ((double)blocks * BLOCK_POINTS);
}

/* Merges yarns that are alike. Turning the frame of a weft leaves the integral over both hemispheres as it is. */
static int collect_kinds(const weft_weave *weave, kind_of_yarn *kind)
{
    int count = 0;
    for (int i = 0; i < weave->yarn_count; i++) {
        const weft_yarn *yarn = &weave->yarn[i];
        double share = (double)yarn->cell_fraction * yarn->area_weight;
        const weft_prepared_segment *prepared = &weave->yarn[yarn->alike].prepared;
        if (!yarn->admissible || !(share > 0))
            continue;
        int k = 0;
        while (k < count && kind[k].prepared != prepared)
            k++;
        if (k == count)
            kind[count++] = (kind_of_yarn){prepared, 0};
        kind[k].share += share;
    }
    return count;
}

static double inverse_scale(const kind_of_yarn *kind, int count)
{
    int blocks = (int)weft_clamp((weft_real)(BUDGET_BLOCKS / (count > 0 ? count : 1)), MIN_BLOCKS, MAX_BLOCKS);
    double sum = 0;
    for (int k = 0; k < count; k++)
        sum += kind[k].share * mean_reflectance(kind[k].prepared, blocks);
    return (double)WEFT_PI * sum;
}

weft_real weft_weave_specular_scale(const weft_weave *weave)
{
    kind_of_yarn kind[WEFT_WEAVE_MAX_YARNS];
    double inverse = inverse_scale(kind, collect_kinds(weave, kind));
    return inverse > 0 ? (weft_real)(1 / inverse) : 0;
}
