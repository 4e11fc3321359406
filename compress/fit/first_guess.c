/* Fits from nothing. */
#include "compress/fit/workspace.h"

#include "base/integers.h"

#include <math.h>
#include <string.h>

static const weft_fit_lobe mirror_start = {.c = {-0.95, -0.9, 1}, .log_exponent = 2.0794};
static const weft_fit_lobe broad_start = {.c = {-0.1, -0.15, 1}, .log_exponent = 0.4055};

enum {
    RACE_PASSES = 4,
    START_PASSES = 6,
    SCREENED = 4, /* lobes that are followed of those that the screen ranks */
    INCUMBENT = 2,
    CHALLENGER /* places among the trials of a workspace */
};

#define CLEARLY_BETTER 0.98 /* times the residual: few passes over few lights tell no finer differences */
#define START_TOLERANCE 1e-2
#define BEATEN 1.2 /* a start that has so many times the residual of the best after RACE_PASSES is not followed */
#define NEAR 1.1   /* nor is a challenger refined that leaves so many times what the incumbent leaves */
#define ALIKE 0.99 /* of two residuals: both starts have found the same, and the screen is followed no further */
#define SPLIT_LOG_RATIO 1.3863 /* ln 4 */
#define SHARP 4.1589           /* ln 64: a lobe from here on is split for two lobes, too */
#define WORTHWHILE 0.98        /* a frame is turned only where that takes at least 2 % off the squared error */

/* A search that grows lobe by lobe. The incumbent comes from the usual starts, which cloth mostly wants; the challenger
 * is the best of all others, and has to be clearly better: shapes that few samples tell apart may glare elsewhere. */
typedef struct search {
    const weft_bundle *bundle;
    const weft_samples *samples;
    int channel;
    weft_fit_options wanted;  /* of the fit with so many lobes */
    weft_fit_options options; /* of its starts */
    weft_fit_workspace *workspace;
    bool has_incumbent, has_challenger;
    double left[WEFT_TRIALS]; /* what those two leave where T keeps within a moderate contrast */
    double quarters;          /* of passes */
} search;

/* A T that is not finite comes of a model that vanishes in all of a view but for rounding: such a fit is worth nothing.
 */
static double moderate_residual(const search *own)
{
    const weft_trial *now = &own->workspace->trial[0];
    double left = own->wanted.table ? weft_trial_moderate_residual(own->bundle, now) : now->residual;
    return isfinite(left) ? left : INFINITY;
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

/* Follows a start that has been looked at once; to the end only if it does not fall behind. */
static void follow(search *own, bool is_usual)
{
    weft_fit_workspace *workspace = own->workspace;
    weft_fit_options race = own->options;
    double least = least_so_far(own);
    race.max_passes = RACE_PASSES;
    race.wanted = isfinite(least) ? BEATEN * least : 0;
    if (isfinite(least))
        weft_workspace_refine(own->bundle, own->samples, own->channel, &race, workspace, 0.1);
    if (workspace->trial[0].residual < BEATEN * least)
        weft_workspace_refine(own->bundle, own->samples, own->channel, &own->options, workspace, 0.1);
    own->quarters += (own->options.coarse ? 1 : 4) * workspace->trial[0].fit.passes;
    keep(own, is_usual);
}

/* Only the shapes of `start` count. */
static void look_at(const search *own, const weft_fit_options *options, const weft_fit *start)
{
    weft_trial *now = &own->workspace->trial[0];
    now->fit = *start;
    now->fit.passes = 0;
    weft_workspace_begin_cold(own->bundle, own->samples, own->channel, options, now);
}

static void try_shapes(search *own, const weft_fit *start, bool is_usual)
{
    look_at(own, &own->options, start);
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

/* Whether the best challenger leaves as much as the incumbent. */
static bool are_alike(const search *own)
{
    double a = own->left[INCUMBENT], b = own->left[CHALLENGER];
    return own->has_incumbent && own->has_challenger && fmin(a, b) > ALIKE * fmax(a, b);
}

/* Finds starts with one lobe more than `base`, with few passes over few lights. The best comes first. Returns their
 * number, 1 or 2. */
static int grow(search *own, const weft_frame *frame, const weft_fit *base, weft_fit start[2])
{
    weft_trial *trial = own->workspace->trial;
    weft_fit_lobe lobe[SCREENED];
    look_at(own, &own->options, base);
    own->quarters += own->options.coarse ? 1 : 4;
    weft_trial_swap(&trial[0], &trial[INCUMBENT]);
    int found = weft_screen_run(own->bundle, own->samples, own->channel, &own->options, own->workspace,
                                &trial[INCUMBENT], SCREENED, lobe);
    own->has_incumbent = own->has_challenger = false;
    bool is_usual = own->options.lobe_count > 2;
    if (!is_usual) {
        weft_fit usual = usual_start(own->options.lobe_count, frame);
        try_shapes(own, &usual, true);
    }
    for (int split = 0; split < base->lobe_count; split++) {
        weft_fit more = with_lobe_split(base, split);
        if (is_usual || base->lobe[split].log_exponent >= SHARP)
            try_shapes(own, &more, is_usual);
    }
    for (int i = 0; i < found && (i == 0 || !are_alike(own)); i++) {
        weft_fit more = *base;
        more.lobe[more.lobe_count++] = lobe[i];
        try_shapes(own, &more, false);
    }
    settle(own);
    start[0] = trial[INCUMBENT].fit;
    start[1] = trial[CHALLENGER].fit;
    bool is_alone = own->options.lobe_count == 1;
    return own->has_challenger && (is_alone || own->left[CHALLENGER] < NEAR * own->left[INCUMBENT]) ? 2 : 1;
}

/* ---- From a start to a fit ---- */

/* Refines the start that was looked at. It stops where it will not leave less than `wanted` (0: goes on). */
static void refine(const search *own, bool turning, double wanted, weft_fit *fit, double *table)
{
    weft_trial *now = &own->workspace->trial[0];
    weft_fit_options options = own->wanted;
    options.fit_frame = turning;
    options.wanted = wanted;
    weft_workspace_refine(own->bundle, own->samples, own->channel, &options, own->workspace, 0.01);
    weft_workspace_finish(own->bundle, &options, now, fit, table);
}

/* Refines the start that was looked at, with its frame, and in its frame as long as that may leave nearly as little.
 * Returns what is left. A diffuse term has no use for turns. */
static double finish(const search *own, weft_fit *fit, double *table)
{
    if (!own->wanted.fit_frame || own->workspace->trial[0].fit.lobe_count == 0) {
        refine(own, false, 0, fit, table);
        return moderate_residual(own);
    }
    const weft_fit start = own->workspace->trial[0].fit;
    double *still_table = own->workspace->scratch[0];
    weft_fit still;
    refine(own, true, 0, fit, table);
    fit->has_turned = true;
    double left = moderate_residual(own), most = fit->residual / WORTHWHILE;
    look_at(own, &own->wanted, &start);
    refine(own, false, most, &still, still_table);
    still.passes += fit->passes;
    fit->passes = still.passes;
    if (!(still.residual <= most))
        return left;
    *fit = still;
    memcpy(table, still_table, (size_t)own->bundle->view_count * sizeof *table);
    return moderate_residual(own);
}

/* Whether a start that had a few passes over all lights has come near what another left in the end. The first steps of
 * a lobe that is alone tell nothing of that: it may have a long way to go. */
static bool catches_up(const search *own, double left)
{
    weft_fit_options race = own->wanted;
    race.fit_frame = false;
    race.max_passes = START_PASSES;
    race.wanted = race.lobe_count > 1 ? NEAR * left : 0;
    weft_workspace_refine(own->bundle, own->samples, own->channel, &race, own->workspace, 0.01);
    return moderate_residual(own) < NEAR * left;
}

/* Takes the second start where it ends clearly better than the first. */
static void try_second(const search *own, const weft_fit *start, double left, weft_fit *fit, double *table)
{
    weft_trial *now = &own->workspace->trial[0], *best = &own->workspace->trial[INCUMBENT];
    double *other_table = own->workspace->scratch[1];
    weft_fit other;
    weft_trial_swap(now, best);
    look_at(own, &own->wanted, start);
    bool is_near = catches_up(own, left),
         is_better = is_near && finish(own, &other, other_table) < CLEARLY_BETTER * left;
    int passes = fit->passes + (is_near ? other.passes : now->fit.passes);
    if (is_better) {
        *fit = other;
        memcpy(table, other_table, (size_t)own->bundle->view_count * sizeof *table);
    } else {
        weft_trial_swap(now, best);
    }
    fit->passes = passes;
}

/* A fit that is only a step to one with more lobes looks at the coarse lights alone. */
static void set_options(const weft_bundle *bundle, const weft_fit_options *options, int lobe_count, search *own)
{
    own->wanted = *options;
    own->wanted.lobe_count = lobe_count;
    own->wanted.coarse |= lobe_count < options->lobe_count && bundle->is_coarse;
    own->options = own->wanted;
    own->options.fit_frame = false;
    own->options.coarse = bundle->is_coarse;
    own->options.max_passes = START_PASSES;
    own->options.tolerance = START_TOLERANCE;
}

/* Black leaves the energy of the samples: where most are negative, nearly equal lobes may leave more. */
static void blacken(double energy, weft_fit *fit)
{
    fit->diffuse = 0;
    for (int i = 0; i < fit->lobe_count; i++)
        fit->lobe[i].amplitude = 0;
    fit->residual = energy;
}

/* The fit with one lobe more than `base`; without `base`, the diffuse term alone. */
static void fit_next(search *own, const weft_frame *frame, const weft_fit *base, weft_fit *fit, double *table)
{
    const weft_fit nothing = {.frame = *frame};
    weft_fit start[2] = {nothing};
    int count = base ? grow(own, frame, base, start) : 1;
    look_at(own, &own->wanted, &start[0]);
    if (!isfinite(moderate_residual(own)))
        look_at(own, &own->wanted, &nothing);
    double left = finish(own, fit, table);
    if (count > 1)
        try_second(own, &start[1], left, fit, table);
    own->quarters += (own->wanted.coarse ? 1 : 4) * fit->passes;
    if (!own->wanted.coarse && fit->residual > own->samples->energy[own->channel])
        blacken(own->samples->energy[own->channel], fit);
}

void weft_fit_cold(const weft_bundle *bundle, const weft_samples *samples, int channel, const weft_fit_options *options,
                   weft_fit_workspace *workspace, const weft_frame *frame, weft_fit *fit, double *table)
{
    search own = {.bundle = bundle, .samples = samples, .channel = channel, .workspace = workspace};
    *fit = (weft_fit){.frame = *frame, .lobe_count = options->lobe_count};
    if (weft_workspace_finish_empty(bundle, samples, channel, fit, table))
        return;
    for (int count = 0; count <= options->lobe_count; count++) {
        const weft_fit base = *fit;
        set_options(bundle, options, count, &own);
        fit_next(&own, frame, count > 0 ? &base : NULL, fit, table);
    }
    fit->passes = (int)ceil(own.quarters / 4);
}
