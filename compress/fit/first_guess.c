/* Fits from nothing. */
#include "compress/fit/screen.h"

#include "base/integers.h"

#include <math.h>
#include <string.h>

static const weft_fit_lobe mirror_start = {.c = {-0.95, -0.9, 1}, .log_exponent = 2.0794};
static const weft_fit_lobe broad_start = {.c = {-0.1, -0.15, 1}, .log_exponent = 0.4055};

enum {
    RACE_PASSES = 3,
    START_PASSES = 6,
    SCREENED = 3, /* lobes that are followed of those that the screen ranks */
    INCUMBENT = 2,
    CHALLENGER /* places among the trials of a workspace */
};

#define CLEARLY_BETTER 0.98 /* times the residual: few passes over few lights tell no finer differences */
#define START_TOLERANCE 1e-2
#define BEATEN 1.2 /* a start that has so many times the residual of the best after RACE_PASSES is not followed */
#define CLOSE 1.3  /* a challenger that leaves so many times what the incumbent leaves is not refined */
#define SPLIT_LOG_RATIO 1.3863 /* ln 4 */

/* A search that grows lobe by lobe. The incumbent comes from the usual starts, which cloth mostly wants; the challenger
 * is the best of all others, and has to be clearly better: shapes that few samples tell apart may glare elsewhere. */
typedef struct search {
    const weft_bundle *bundle;
    const weft_samples *samples;
    int channel;
    weft_fit_options options; /* of the starts */
    weft_fit_workspace *workspace;
    bool has_incumbent, has_challenger;
    double left[WEFT_TRIALS]; /* what those two leave where T keeps within a moderate contrast */
    double quarters;          /* of passes */
} search;

static double moderate_residual(const search *own)
{
    const weft_trial *now = &own->workspace->trial[0];
    return own->options.table ? weft_trial_moderate_residual(own->bundle, now) : now->residual;
}

static void keep(search *own, bool is_usual)
{
    int at = is_usual ? INCUMBENT : CHALLENGER;
    weft_trial *now = &own->workspace->trial[0], *place = &own->workspace->trial[at];
    bool *is_taken = is_usual ? &own->has_incumbent : &own->has_challenger;
    double left = moderate_residual(own);
    if (!*is_taken || left < own->left[at]) {
        weft_trial_swap(now, place);
        own->left[at] = left;
    }
    *is_taken = true;
}

/* What the best so far leaves. */
static double least_so_far(const search *own)
{
    double least = own->has_incumbent ? own->left[INCUMBENT] : INFINITY;
    return own->has_challenger ? fmin(least, own->left[CHALLENGER]) : least;
}

static void count_passes(search *own, bool coarse)
{
    own->quarters += (coarse ? 1 : 4) * own->workspace->trial[0].fit.passes;
}

/* Follows a start that has been looked at once; to the end only if it does not fall behind. */
static void follow(search *own, bool is_usual)
{
    weft_fit_workspace *workspace = own->workspace;
    weft_fit_options race = own->options;
    double least = least_so_far(own);
    race.max_passes = RACE_PASSES;
    if (isfinite(least))
        weft_workspace_refine(own->bundle, own->samples, own->channel, &race, workspace, 0.1);
    if (workspace->trial[0].residual < BEATEN * least)
        weft_workspace_refine(own->bundle, own->samples, own->channel, &own->options, workspace, 0.1);
    count_passes(own, own->options.coarse);
    keep(own, is_usual);
}

/* Only the shapes of `start` count. */
static void try_shapes(search *own, const weft_fit *start, bool is_usual)
{
    weft_trial *now = &own->workspace->trial[0];
    now->fit = *start;
    now->fit.passes = 0;
    weft_workspace_begin_cold(own->bundle, own->samples, own->channel, &own->options, now);
    follow(own, is_usual);
}

static weft_fit usual_start(int lobe_count, const weft_frame *frame)
{
    weft_fit fit = {.frame = *frame, .lobe_count = lobe_count, .lobe = {mirror_start, broad_start}};
    return fit;
}

/* The fit with one lobe more: number `split` once more, but broader. Which lobe has a shape that one power cannot
 * follow is not known beforehand. */
static weft_fit with_lobe_split(const weft_fit *fit, int split)
{
    weft_fit more = *fit;
    weft_fit_lobe *added = &more.lobe[more.lobe_count++];
    *added = fit->lobe[split];
    added->log_exponent = fmax(0, added->log_exponent - SPLIT_LOG_RATIO);
    return more;
}

/* The better one leads: it is the incumbent from here on. */
static void settle(search *own)
{
    weft_trial *trial = own->workspace->trial;
    if (!own->has_challenger || own->left[CHALLENGER] >= CLEARLY_BETTER * own->left[INCUMBENT])
        return;
    double left = own->left[INCUMBENT];
    weft_trial_swap(&trial[INCUMBENT], &trial[CHALLENGER]);
    own->left[INCUMBENT] = own->left[CHALLENGER];
    own->left[CHALLENGER] = left;
}

/* From the best fit to the best with one lobe more. */
static void grow(search *own)
{
    weft_fit_workspace *workspace = own->workspace;
    const weft_fit base = workspace->trial[INCUMBENT].fit;
    weft_fit_lobe lobe[SCREENED];
    int found = weft_screen_run(own->bundle, own->samples, own->channel, &own->options, workspace,
                                &workspace->trial[INCUMBENT], SCREENED, lobe);
    own->has_incumbent = own->has_challenger = false;
    own->options.lobe_count = base.lobe_count + 1;
    if (own->options.lobe_count <= 2) {
        weft_fit usual = usual_start(own->options.lobe_count, &base.frame);
        try_shapes(own, &usual, true);
    }
    for (int split = 0; split < base.lobe_count; split++) {
        weft_fit more = with_lobe_split(&base, split);
        try_shapes(own, &more, own->options.lobe_count > 2);
    }
    for (int i = 0; i < found; i++) {
        weft_fit more = base;
        more.lobe[more.lobe_count++] = lobe[i];
        more.start = 1;
        try_shapes(own, &more, false);
    }
    settle(own);
}

/* From few passes over the coarse lights to a fit. */
static void refine(search *own, const weft_fit_options *options, weft_fit *fit, double *table)
{
    weft_trial *now = &own->workspace->trial[0];
    weft_workspace_refine(own->bundle, own->samples, own->channel, options, own->workspace, 0.01);
    weft_workspace_finish(own->bundle, options, now, fit, table);
    count_passes(own, false);
    now->fit.passes = 0;
}

/* Returns what is left where T keeps within a moderate contrast. */
static double refine_finalist(search *own, int place, const weft_fit_options *options, bool turn, weft_finalist *to)
{
    weft_trial *now = &own->workspace->trial[0];
    weft_fit_options turning = *options;
    turning.fit_frame = true;
    weft_trial_swap(now, &own->workspace->trial[place]);
    now->fit.passes = 0;
    if (own->options.coarse)
        weft_workspace_complete(own->bundle, own->samples, own->channel, options, now);
    refine(own, options, &to->upright, to->upright_table);
    if (turn)
        refine(own, &turning, &to->turned, to->turned_table);
    return moderate_residual(own);
}

static void swap_finalists(weft_finalist *a, weft_finalist *b)
{
    weft_finalist swap = *a;
    *a = *b;
    *b = swap;
}

int weft_fit_search(const weft_bundle *bundle, const weft_samples *samples, int channel,
                    const weft_fit_options *options, bool turn, weft_fit_workspace *workspace, const weft_frame *frame,
                    weft_finalist finalist[WEFT_FINALISTS], double share[WEFT_MATERIAL_MAX_LOBES + 1])
{
    weft_finalist *best = &finalist[0], *other = &finalist[1];
    best->upright = (weft_fit){.frame = *frame, .lobe_count = options->lobe_count};
    share[options->lobe_count] = 1;
    if (weft_workspace_finish_empty(bundle, samples, channel, &best->upright, best->upright_table)) {
        for (int i = 0; i < options->lobe_count; i++)
            share[i] = 1;
        best->turned = best->upright;
        if (turn)
            weft_workspace_finish_empty(bundle, samples, channel, &best->turned, best->turned_table);
        return 1;
    }
    search own = {
        .bundle = bundle, .samples = samples, .channel = channel, .options = *options, .workspace = workspace};
    const weft_trial *trial = workspace->trial;
    const weft_fit nothing = {.frame = *frame};
    own.options.coarse = bundle->is_coarse;
    own.options.max_passes = START_PASSES;
    own.options.tolerance = START_TOLERANCE;
    own.options.lobe_count = 0;
    try_shapes(&own, &nothing, true);
    share[0] = trial[INCUMBENT].residual;
    while (own.options.lobe_count < options->lobe_count) {
        grow(&own);
        share[own.options.lobe_count] = trial[INCUMBENT].residual;
    }
    double whole = share[options->lobe_count];
    for (int i = 0; i <= options->lobe_count; i++)
        share[i] = whole > 0 ? share[i] / whole : 1;
    bool two = own.has_challenger && (options->lobe_count == 1 || own.left[CHALLENGER] < CLOSE * own.left[INCUMBENT]);
    double left = refine_finalist(&own, INCUMBENT, options, turn, best);
    if (two) {
        weft_trial_swap(&workspace->trial[0], &workspace->trial[INCUMBENT]);
        if (refine_finalist(&own, CHALLENGER, options, turn, other) < CLEARLY_BETTER * left)
            swap_finalists(best, other);
        else
            weft_trial_swap(&workspace->trial[0], &workspace->trial[INCUMBENT]);
    }
    best->upright.passes = (int)ceil(own.quarters / 4);
    return two ? 2 : 1;
}

void weft_fit_cold(const weft_bundle *bundle, const weft_samples *samples, int channel, const weft_fit_options *options,
                   weft_fit_workspace *workspace, const weft_frame *frame, weft_fit *fit, double *table)
{
    double share[WEFT_MATERIAL_MAX_LOBES + 1];
    weft_finalist finalist[WEFT_FINALISTS] = {{.upright_table = workspace->finalist_table[0]},
                                              {.upright_table = workspace->finalist_table[1]}};
    weft_fit_search(bundle, samples, channel, options, false, workspace, frame, finalist, share);
    *fit = finalist[0].upright;
    memcpy(table, finalist[0].upright_table, (size_t)bundle->view_count * sizeof *table);
}
