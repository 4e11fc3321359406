/* Fits from nothing. */
#include "compress/workspace.h"

#include <math.h>
#include <string.h>

static const weft_fit_lobe mirror_start = {.c = {-0.95, -0.9, 1}, .log_exponent = 2.0794};
static const weft_fit_lobe retro_start = {.c = {0.9, 0.95, 1}, .log_exponent = 2.0794};
static const weft_fit_lobe broad_start = {.c = {-0.1, -0.15, 1}, .log_exponent = 0.4055};

enum { START_COUNT = 2, START_PASSES = 3 };

#define START_TOLERANCE 1e-2

/* Start number `index`: the mirror and a broad lobe, or the same thrown back to the light. */
static void place_start(int index, int lobe_count, weft_fit *fit)
{
    const weft_fit_lobe *order[START_COUNT][WEFT_GRAM_LOBES] = {{&mirror_start, &broad_start, &retro_start},
                                                                {&retro_start, &broad_start, &mirror_start}};
    fit->start = index;
    fit->lobe_count = lobe_count;
    for (int i = 0; i < lobe_count; i++)
        fit->lobe[i] = *order[index][i];
}

void weft_fit_cold(const weft_bundle *bundle, const weft_samples *samples, int channel, const weft_fit_options *options,
                   weft_fit_workspace *workspace, const weft_frame *frame, weft_fit *fit, double *table)
{
    *fit = (weft_fit){.frame = *frame, .lobe_count = options->lobe_count};
    if (weft_workspace_finish_empty(bundle, samples, channel, fit, table))
        return;
    weft_trial *now = &workspace->trial[0];
    weft_fit best = {.residual = INFINITY};
    weft_fit_options coarse = *options;
    coarse.coarse = true;
    coarse.max_passes = START_PASSES;
    coarse.tolerance = START_TOLERANCE;
    int passes = 0;
    for (int start = 0; start < (options->lobe_count ? START_COUNT : 1); start++) {
        now->fit = (weft_fit){.frame = *frame};
        place_start(start, options->lobe_count, &now->fit);
        weft_workspace_begin_cold(bundle, samples, channel, &coarse, now);
        weft_workspace_refine(bundle, samples, channel, &coarse, workspace, 0.1);
        passes += (now->fit.passes + 3) / 4;
        if (now->residual < best.residual) {
            best = now->fit;
            best.residual = now->residual;
            memcpy(workspace->table, now->table, (size_t)bundle->view_count * sizeof *now->table);
        }
    }
    now->fit = best;
    now->fit.passes = passes;
    weft_workspace_begin_warm(bundle, samples, channel, options, workspace->table, now);
    weft_fit_options full = *options;
    full.max_passes += passes;
    weft_workspace_refine(bundle, samples, channel, &full, workspace, 0.01);
    weft_workspace_finish(bundle, options, now, fit, table);
}
