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
    SCREENED = 4, /* lobes that are followed of those that the screen ranks */
    INCUMBENT = 2,
    CHALLENGER /* places among the trials of a workspace */
};

#define CLEARLY_BETTER 0.98 /* times the residual: few passes over few lights tell no finer differences */
#define START_TOLERANCE 1e-2
#define BEATEN 1.2 /* a start that has so many times the residual of the best after RACE_PASSES is not followed */
#define NEAR 1.1   /* nor is a challenger refined that leaves so many times what the incumbent leaves */
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
    own->quarters += (own->options.coarse ? 1 : 4) * workspace->trial[0].fit.passes;
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

/* What stage `lobe_count` of a search found. */
static void note_stage(const search *own, weft_starts *to)
{
    const weft_trial *trial = own->workspace->trial;
    int lobes = own->options.lobe_count;
    bool is_close = own->has_challenger && (lobes == 1 || own->left[CHALLENGER] < NEAR * own->left[INCUMBENT]);
    to->count[lobes] = is_close ? 2 : 1;
    to->start[lobes][0] = trial[INCUMBENT].fit;
    if (is_close)
        to->start[lobes][1] = trial[CHALLENGER].fit;
}

void weft_fit_find_starts(const weft_bundle *bundle, const weft_samples *samples, int channel,
                          const weft_fit_options *options, weft_fit_workspace *workspace, const weft_frame *frame,
                          weft_starts *starts)
{
    const weft_fit nothing = {.frame = *frame};
    search own = {
        .bundle = bundle, .samples = samples, .channel = channel, .options = *options, .workspace = workspace};
    starts->passes = 0;
    for (int lobes = 0; lobes <= options->lobe_count; lobes++) {
        starts->count[lobes] = 1;
        starts->start[lobes][0] = (weft_fit){.frame = *frame, .lobe_count = lobes};
    }
    if (!(samples->energy[channel] > 0) || samples->valid_count == 0)
        return;
    own.options.coarse = bundle->is_coarse;
    own.options.max_passes = START_PASSES;
    own.options.tolerance = START_TOLERANCE;
    own.options.lobe_count = 0;
    try_shapes(&own, &nothing, true);
    note_stage(&own, starts);
    while (own.options.lobe_count < options->lobe_count) {
        grow(&own);
        note_stage(&own, starts);
    }
    starts->passes = own.quarters / 4;
}

/* ---- From a start to a fit ---- */

/* What a refinement needs. */
typedef struct refinement {
    const weft_bundle *bundle;
    const weft_samples *samples;
    int channel;
    weft_fit_options options;
    bool turn;
    weft_fit_workspace *workspace;
} refinement;

/* The first look at all lights. */
static void begin(const refinement *own, const weft_fit *start)
{
    weft_trial *now = &own->workspace->trial[0];
    now->fit = *start;
    now->fit.passes = 0;
    weft_workspace_begin_cold(own->bundle, own->samples, own->channel, &own->options, now);
}

/* A T that is not finite comes of a model that vanishes in all of a view but for rounding: such a fit is worth nothing.
 */
static double left_at_moderate_contrast(const refinement *own)
{
    const weft_trial *now = &own->workspace->trial[0];
    double left = own->options.table ? weft_trial_moderate_residual(own->bundle, now) : now->residual;
    return isfinite(left) ? left : INFINITY;
}

static void refine(const refinement *own, const weft_fit_options *options, weft_fit *fit, double *table)
{
    weft_workspace_refine(own->bundle, own->samples, own->channel, options, own->workspace, 0.01);
    weft_workspace_finish(own->bundle, options, &own->workspace->trial[0], fit, table);
}

/* Returns what is left upright, or turned if it is turned. */
static double finish(const refinement *own, weft_finalist *to)
{
    weft_trial *now = &own->workspace->trial[0];
    weft_fit_options turning = own->options;
    turning.fit_frame = true;
    refine(own, &own->options, &to->upright, to->upright_table);
    if (own->turn) {
        now->fit.passes = 0;
        refine(own, &turning, &to->turned, to->turned_table);
    }
    return left_at_moderate_contrast(own);
}

/* Whether a start that had a few passes over all lights has come near what another left in the end. The first steps of
 * a lobe that is alone tell nothing of that: it may have a long way to go. */
static bool catches_up(const refinement *own, double left)
{
    weft_fit_options race = own->options;
    race.max_passes = START_PASSES;
    race.wanted = own->options.lobe_count > 1 ? NEAR * left : 0;
    weft_workspace_refine(own->bundle, own->samples, own->channel, &race, own->workspace, 0.01);
    return left_at_moderate_contrast(own) < NEAR * left;
}

static void swap_finalists(weft_finalist *a, weft_finalist *b)
{
    weft_finalist swap = *a;
    *a = *b;
    *b = swap;
}

static int finish_empty(const refinement *own, const weft_fit *start, weft_finalist *to)
{
    to->upright = to->turned = *start;
    weft_workspace_finish_empty(own->bundle, own->samples, own->channel, &to->upright, to->upright_table);
    if (own->turn)
        weft_workspace_finish_empty(own->bundle, own->samples, own->channel, &to->turned, to->turned_table);
    return 1;
}

int weft_fit_refine_starts(const weft_bundle *bundle, const weft_samples *samples, int channel,
                           const weft_fit_options *options, bool turn, weft_fit_workspace *workspace,
                           const weft_starts *starts, int most, weft_finalist *finalist)
{
    const weft_fit *start = starts->start[options->lobe_count];
    const refinement own = {bundle, samples, channel, *options, turn, workspace};
    weft_trial *now = &workspace->trial[0], *best = &workspace->trial[INCUMBENT];
    if (!(samples->energy[channel] > 0) || samples->valid_count == 0)
        return finish_empty(&own, &start[0], &finalist[0]);
    begin(&own, &start[0]);
    if (!isfinite(left_at_moderate_contrast(&own)))
        begin(&own, &starts->start[0][0]);
    double left = finish(&own, &finalist[0]);
    int passes = finalist[0].upright.passes + (int)ceil(starts->passes), count = 1;
    if (weft_smaller(starts->count[options->lobe_count], most) > 1) {
        weft_trial_swap(now, best);
        begin(&own, &start[1]);
        count += catches_up(&own, left);
        bool is_better = count > 1 && finish(&own, &finalist[1]) < CLEARLY_BETTER * left;
        passes += count > 1 ? finalist[1].upright.passes : now->fit.passes;
        if (is_better)
            swap_finalists(&finalist[0], &finalist[1]);
        else
            weft_trial_swap(now, best);
    }
    finalist[0].upright.passes = passes;
    return count;
}

void weft_fit_from_starts(const weft_bundle *bundle, const weft_samples *samples, int channel,
                          const weft_fit_options *options, weft_fit_workspace *workspace, const weft_starts *starts,
                          weft_fit *fit, double *table)
{
    weft_finalist finalist[WEFT_FINALISTS] = {{.upright_table = workspace->finalist_table[0]},
                                              {.upright_table = workspace->finalist_table[1]}};
    weft_fit_refine_starts(bundle, samples, channel, options, false, workspace, starts, WEFT_FINALISTS, finalist);
    *fit = finalist[0].upright;
    memcpy(table, finalist[0].upright_table, (size_t)bundle->view_count * sizeof *table);
}

void weft_fit_cold(const weft_bundle *bundle, const weft_samples *samples, int channel, const weft_fit_options *options,
                   weft_fit_workspace *workspace, const weft_frame *frame, weft_fit *fit, double *table)
{
    weft_starts starts;
    weft_fit_find_starts(bundle, samples, channel, options, workspace, frame, &starts);
    weft_fit_from_starts(bundle, samples, channel, options, workspace, &starts, fit, table);
}
