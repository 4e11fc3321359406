/* Fits from nothing. */
#include "compress/fit/workspace.h"

#include <math.h>
#include <string.h>

static const weft_fit_lobe mirror_start = {.c = {-0.95, -0.9, 1}, .log_exponent = 2.0794};
static const weft_fit_lobe retro_start = {.c = {0.9, 0.95, 1}, .log_exponent = 2.0794};
static const weft_fit_lobe broad_start = {.c = {-0.1, -0.15, 1}, .log_exponent = 0.4055};
static const weft_fit_lobe along_x_start = {.c = {1, 0.1, 0.2}, .log_exponent = 0.4055};
static const weft_fit_lobe along_y_start = {.c = {0.1, 1, 0.2}, .log_exponent = 0.4055};

enum { START_COUNT = 3, START_PASSES = 6, RACE_PASSES = 3 };

#define VANISHED 1e-3       /* part of the energy */
#define GOOD_ENOUGH 0.1     /* of the energy: no further start is tried below */
#define CLEARLY_BETTER 0.98 /* times the residual: few passes over few lights tell no finer differences */
#define START_TOLERANCE 1e-2
#define HOPELESS 3 /* a start whose first residual is so many times that of the first start is not followed */
#define BEATEN 1.2 /* a start that has so many times the residual of the best after RACE_PASSES is not, either */
#define SPLIT_LOG_RATIO 1.3863 /* ln 4 */

/* Start number `index`: the mirror and a broad lobe, the same thrown back to the light, or two that are thrown back
 * along the surface: what cylinders, fuzz and everything else does that falls off more slowly than the cosine, where
 * the lobes of the other two would have to be negative and vanish. */
static void place_start(int index, int lobe_count, weft_fit *fit)
{
    const weft_fit_lobe *order[START_COUNT][WEFT_GRAM_LOBES] = {{&mirror_start, &broad_start, &retro_start},
                                                                {&retro_start, &broad_start, &mirror_start},
                                                                {&along_x_start, &along_y_start, &broad_start}};
    fit->start = index;
    fit->lobe_count = lobe_count;
    for (int i = 0; i < lobe_count; i++)
        fit->lobe[i] = *order[index][i];
}

static bool has_vanished_lobe(const weft_trial *trial)
{
    for (int i = 0; i < trial->fit.lobe_count; i++) {
        double amplitude = trial->fit.lobe[i].amplitude;
        if (amplitude * amplitude * trial->strength[1 + i] < VANISHED * trial->energy)
            return true;
    }
    return false;
}

/* Follows a start that has been looked at once; one that came after others, to the end only if it does not fall behind
 * `best`. */
static void follow(const weft_bundle *bundle, const weft_samples *samples, int channel, const weft_fit_options *options,
                   weft_fit_workspace *workspace, double best)
{
    weft_fit_options race = *options;
    race.max_passes = RACE_PASSES;
    if (isfinite(best))
        weft_workspace_refine(bundle, samples, channel, &race, workspace, 0.1);
    if (workspace->trial[0].residual < BEATEN * best)
        weft_workspace_refine(bundle, samples, channel, options, workspace, 0.1);
}

/* The best start after a few coarse passes, into workspace->trial[0]. */
static void try_starts(const weft_bundle *bundle, const weft_samples *samples, int channel,
                       const weft_fit_options *options, weft_fit_workspace *workspace, const weft_frame *frame)
{
    weft_trial *now = &workspace->trial[0], *best = &workspace->trial[2];
    double first_residual = INFINITY;
    int passes = 0;
    bool vanished = false;
    for (int start = 0; start < (options->lobe_count ? START_COUNT : 1); start++) {
        /* A quarter of the lights hold a quarter of the energy. */
        if (start > 0 && best->residual < GOOD_ENOUGH * samples->energy[channel] / 4 && !vanished)
            break;
        now->fit = (weft_fit){.frame = *frame};
        place_start(start, options->lobe_count, &now->fit);
        weft_workspace_begin_cold(bundle, samples, channel, options, now);
        first_residual = fmin(first_residual, now->residual);
        if (now->residual <= HOPELESS * first_residual)
            follow(bundle, samples, channel, options, workspace, start ? best->residual : INFINITY);
        passes += (now->fit.passes + 3) / 4;
        if (start == 0 || now->residual < CLEARLY_BETTER * best->residual) {
            vanished = has_vanished_lobe(now);
            weft_trial_swap(now, best);
        }
    }
    weft_trial_swap(now, best);
    now->fit.passes = passes;
}

static void fit_from_starts(const weft_bundle *bundle, const weft_samples *samples, int channel,
                            const weft_fit_options *options, weft_fit_workspace *workspace, const weft_frame *frame,
                            weft_fit *fit, double *table)
{
    *fit = (weft_fit){.frame = *frame, .lobe_count = options->lobe_count};
    if (weft_workspace_finish_empty(bundle, samples, channel, fit, table))
        return;
    weft_fit_options coarse = *options, full = *options;
    coarse.coarse = true;
    coarse.max_passes = START_PASSES;
    coarse.tolerance = START_TOLERANCE;
    weft_trial *now = &workspace->trial[0];
    try_starts(bundle, samples, channel, &coarse, workspace, frame);
    full.max_passes += now->fit.passes;
    weft_workspace_complete(bundle, samples, channel, options, now);
    weft_workspace_refine(bundle, samples, channel, &full, workspace, 0.01);
    weft_workspace_finish(bundle, options, now, fit, table);
}

/* The fit with one lobe more: number `split` once more, but broader. */
static weft_fit with_lobe_split(const weft_fit *fit, int split)
{
    weft_fit more = *fit;
    weft_fit_lobe *added = &more.lobe[more.lobe_count++];
    *added = fit->lobe[split];
    added->log_exponent = fmax(0, added->log_exponent - SPLIT_LOG_RATIO);
    more.passes = 0;
    return more;
}

/* Three lobes from the best two: which of them has a shape that one power cannot follow is not known beforehand. */
static void fit_by_splitting(const weft_bundle *bundle, const weft_samples *samples, int channel,
                             const weft_fit_options *options, weft_fit_workspace *workspace, const weft_frame *frame,
                             weft_fit *fit, double *table)
{
    weft_fit_options less = *options;
    less.lobe_count--;
    fit_from_starts(bundle, samples, channel, &less, workspace, frame, fit, table);
    const weft_fit few = *fit;
    double *first = workspace->scratch[0], *best = workspace->scratch[1];
    size_t size = (size_t)bundle->view_count * sizeof *table;
    int passes = few.passes;
    if (!(samples->energy[channel] > 0)) {
        fit->lobe_count = options->lobe_count;
        return;
    }
    memcpy(first, table, size);
    for (int split = 0; split < less.lobe_count; split++) {
        weft_fit candidate = with_lobe_split(&few, split);
        memcpy(table, first, size);
        weft_fit_refine(bundle, samples, channel, options, workspace, &candidate, table);
        passes += candidate.passes;
        if (split == 0 || candidate.residual < fit->residual) {
            *fit = candidate;
            memcpy(best, table, size);
        }
    }
    memcpy(table, best, size);
    weft_trial *now = &workspace->trial[0];
    now->fit = *fit;
    weft_workspace_begin_warm(bundle, samples, channel, options, weft_workspace_keep_table(bundle, workspace, table),
                              now);
    weft_workspace_finish(bundle, options, now, fit, table);
    fit->passes = passes + 1;
}

void weft_fit_cold(const weft_bundle *bundle, const weft_samples *samples, int channel, const weft_fit_options *options,
                   weft_fit_workspace *workspace, const weft_frame *frame, weft_fit *fit, double *table)
{
    if (options->lobe_count < 3)
        fit_from_starts(bundle, samples, channel, options, workspace, frame, fit, table);
    else
        fit_by_splitting(bundle, samples, channel, options, workspace, frame, fit, table);
}
