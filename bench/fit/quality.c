#include "bench/fit/sections.h"
#include "bench/fit/statistics.h"
#include "tests/support/alternation.h"

#include <math.h>
#include <stdlib.h>

enum { RANDOM_STARTS = 5, CONVERGED_ROUNDS = 500 };

#define CONVERGED_THRESHOLD 0.001 /* mean change of T */

/* Residuals of one texel. */
typedef struct finding {
    double fast, converged, best_random;
} finding;

static double between(uint64_t *state, double low, double high)
{
    return low + (high - low) * synthetic_uniform(state);
}

/* Any lobes: c in a cube, N from 1 to 50 evenly in its logarithm. */
static weft_fit random_start(int lobe_count, const weft_frame *frame, uint64_t *state)
{
    weft_fit fit = {.diffuse = 0.5, .lobe_count = lobe_count, .frame = *frame};
    for (int i = 0; i < lobe_count; i++) {
        fit.lobe[i] = (weft_fit_lobe){.c = {between(state, -1, 1), between(state, -1, 1), 1},
                                      .log_exponent = between(state, 0, log(50)),
                                      .amplitude = between(state, 0.1, 1)};
    }
    return fit;
}

static double best_of_random_starts(bench *with, int channel, uint64_t seed)
{
    const weft_bundle *bundle = &with->source->bundle;
    const weft_frame frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_fit_options options = with->options;
    options.tolerance = 1e-6;
    options.max_passes = 400;
    double best = INFINITY;
    for (int start = 0; start < RANDOM_STARTS; start++) {
        weft_fit fit = random_start(options.lobe_count, &frame, &seed);
        for (int view = 0; view < bundle->view_count; view++)
            with->table[view] = 1;
        weft_fit_refine(bundle, &with->source->samples, channel, &options, with->workspace, &fit, with->table);
        best = fmin(best, weft_fit_residual(bundle, &with->source->samples, channel, &fit, with->table));
    }
    return best;
}

static weft_code judge(bench *with, int texel, int channel, finding *found, weft_error *error)
{
    const texel_source *source = with->source;
    const weft_frame frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_fit converged;
    found->fast = method_run(with, METHOD_FAST, channel).residual;
    WEFT_TRY(weft_fit_alternate(&source->bundle, &source->samples, channel, &with->options, CONVERGED_THRESHOLD,
                                CONVERGED_ROUNDS, &frame, &converged, with->table, error));
    found->converged = converged.residual;
    found->best_random = best_of_random_starts(with, channel, (uint64_t)texel);
    return WEFT_OK;
}

/* Everything in residuals (sums of squares): 2 % of those are 1 % of the RMSE. */
static void add_table(const bench_plan *plan, const texel_source *source, const finding *found)
{
    int count = plan->texel_count, above_in_residual = 0, above_in_rmse = 0;
    double fast = 0, converged = 0, ratio = 0;
    for (int i = 0; i < count; i++) {
        fast += found[i].fast / count;
        converged += found[i].converged / count;
        ratio += found[i].fast / found[i].converged / count;
        above_in_residual += found[i].fast > 1.02 * found[i].best_random;
        above_in_rmse += sqrt(found[i].fast) > 1.02 * sqrt(found[i].best_random);
    }
    report_table(plan->report, "quality",
                 "Residual of a fit from nothing, over the residual of other fits: %d texels, %d lobes + T", count,
                 plan->lobe_count);
    report_row(plan->report, "%s", source->name);
    report_number(plan->report, "of converged", 4, fast / converged);
    report_number(plan->report, "mean of ratios", 4, ratio);
    report_number(plan->report, "above random, %", 1, 100.0 * above_in_residual / count);
    report_number(plan->report, "in RMSE, %", 1, 100.0 * above_in_rmse / count);
}

weft_code section_quality(const bench_plan *plan, texel_source *source, weft_error *error)
{
    bench with;
    weft_fit_options options = weft_fit_default_options();
    options.lobe_count = plan->lobe_count;
    options.tolerance = plan->tolerance;
    finding *found = calloc((size_t)plan->texel_count, sizeof *found);
    weft_code code = bench_create(source, &options, &with, error);
    if (code == WEFT_OK && !found)
        code = weft_fail_memory(error, "residuals", (size_t)plan->texel_count * sizeof *found);
    for (int i = 0; code == WEFT_OK && i < plan->texel_count; i++) {
        int channel = i % WEFT_CHANNELS;
        code = bench_load(&with, i, plan->texel_count, channel, error);
        if (code == WEFT_OK)
            code = judge(&with, i, channel, &found[i], error);
    }
    if (code == WEFT_OK)
        add_table(plan, source, found);
    free(found);
    bench_free(&with);
    return code;
}
