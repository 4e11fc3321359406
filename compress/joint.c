#include "compress/fit.h"
#include "compress/normal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LEAST_TILT_COSINE 0.35 /* normals beyond 70 degrees are not believed */

struct weft_fit_workspace {
    int view_count;
    weft_trial trial[2]; /* the point reached, and the one being tried */
    double *table;       /* of the best start so far */
};

weft_fit_options weft_fit_default_options(void)
{
    return (weft_fit_options){.lobe_count = 2, .table = true, .max_exponent = 512, .tolerance = 1e-3, .max_passes = 40};
}

static bool create_trial(int view_count, weft_trial *trial)
{
    size_t views = (size_t)view_count;
    trial->pass_table = calloc(views, sizeof *trial->pass_table);
    trial->table = calloc(views, sizeof *trial->table);
    trial->linear = calloc(views, sizeof *trial->linear);
    trial->sums = calloc(views * WEFT_GRAM_STRIDE * WEFT_GRAM_STRIDE, sizeof *trial->sums);
    return trial->pass_table && trial->table && trial->linear && trial->sums;
}

static void free_trial(weft_trial *trial)
{
    free(trial->pass_table);
    free(trial->table);
    free(trial->linear);
    free(trial->sums);
}

weft_code weft_fit_workspace_create(const weft_bundle *bundle, weft_fit_workspace **result, weft_error *error)
{
    weft_fit_workspace *workspace = calloc(1, sizeof *workspace);
    *result = NULL;
    if (!workspace)
        return weft_fail_memory(error, "workspace of a fit", sizeof *workspace);
    workspace->view_count = bundle->view_count;
    workspace->table = calloc((size_t)bundle->view_count, sizeof *workspace->table);
    bool complete = create_trial(bundle->view_count, &workspace->trial[0]);
    complete = create_trial(bundle->view_count, &workspace->trial[1]) && complete && workspace->table;
    if (!complete) {
        weft_fit_workspace_free(workspace);
        return weft_fail_memory(error, "workspace of a fit", (unsigned long long)bundle->view_count * 2048);
    }
    *result = workspace;
    return WEFT_OK;
}

void weft_fit_workspace_free(weft_fit_workspace *workspace)
{
    if (!workspace)
        return;
    free_trial(&workspace->trial[0]);
    free_trial(&workspace->trial[1]);
    free(workspace->table);
    free(workspace);
}

int weft_fit_affordable_lobes(const weft_bundle *bundle, const weft_samples *samples, int wanted, bool table)
{
    int seen = 0;
    for (int view = 0; table && view < bundle->view_count; view++) {
        bool any = false;
        for (int lane = bundle->first_lane[view]; lane < bundle->first_lane[view + 1]; lane++)
            any = any || samples->cosine[lane] > 0;
        seen += any;
    }
    int parameters = (samples->valid_count - 4 * seen) / 4;
    int lobes = (parameters - 1) / 4;
    return lobes < 0 || parameters < 1 ? 0 : lobes < wanted ? lobes : wanted;
}

/* One pass over the samples at trial->fit with the given T. */
static void run_pass(const weft_bundle *bundle, const weft_samples *samples, int channel,
                     const weft_fit_options *options, const double *table, weft_trial *trial)
{
    for (int view = 0; view < bundle->view_count; view++)
        trial->pass_table[view] = table ? (float)table[view] : 0.0f;
    if (!options->table) {
        for (int view = 0; view < bundle->view_count; view++)
            trial->pass_table[view] = 1;
    }
    weft_gram_point point = weft_gram_point_of_fit(&trial->fit);
    /* The digest must use the very numbers of the pass. */
    trial->fit.diffuse = (double)point.diffuse;
    for (int i = 0; i < point.lobe_count; i++)
        trial->fit.lobe[i].amplitude = (double)point.amplitude[i];
    weft_gram_accumulate(bundle, samples->cosine, samples->value[channel], &point, trial->pass_table, options->coarse,
                         trial->sums);
    weft_trial_digest(bundle, options->table, trial);
    trial->fit.passes += 1;
}

/* Brings the largest component of c back to +-1. The amplitude stays: A times (largest)^N is exact but explodes for
 * high N, and the next pass solves for A anyway. */
static void normalise_lobe(weft_fit_lobe *lobe)
{
    double largest = fabs(lobe->c[weft_lobe_fixed(lobe)]);
    if (!(largest > 0)) {
        *lobe = (weft_fit_lobe){.c = {0, 0, 1}, .log_exponent = lobe->log_exponent, .amplitude = lobe->amplitude};
        return;
    }
    for (int k = 0; k < 3; k++)
        lobe->c[k] /= largest;
}

/* Turns the coordinates of a frame by the small rotation w: new l' = l' + w x l' to first order. */
static void rotate_frame(const double w[3], weft_frame *frame)
{
    double angle = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    if (!(angle > 0))
        return;
    double rows[3][3], turned[3][3];
    weft_frame_rows(frame, rows);
    const double axis[3] = {w[0] / angle, w[1] / angle, w[2] / angle};
    const double skew[3][3] = {{0, -axis[2], axis[1]}, {axis[2], 0, -axis[0]}, {-axis[1], axis[0], 0}};
    for (int i = 0; i < 3; i++) {
        for (int column = 0; column < 3; column++) {
            double sum = cos(angle) * rows[i][column];
            for (int k = 0; k < 3; k++)
                sum += (sin(angle) * skew[i][k] + (1 - cos(angle)) * axis[i] * axis[k]) * rows[k][column];
            turned[i][column] = sum;
        }
    }
    frame->normal = weft_unit(weft_vec3_of(turned[2][0], turned[2][1], turned[2][2]));
    weft_vec3 tangent = weft_vec3_of(turned[0][0], turned[0][1], turned[0][2]);
    tangent = weft_subtract(tangent, weft_scale(frame->normal, weft_dot(tangent, frame->normal)));
    frame->tangent = weft_unit(tangent);
    frame->bitangent = weft_cross(frame->normal, frame->tangent);
}

static void step_bounds(const weft_fit *fit, const weft_fit_options *options, int n, double *low, double *high)
{
    low[0] = -fit->diffuse;
    high[0] = INFINITY;
    for (int i = 0; i < fit->lobe_count; i++) {
        const weft_fit_lobe *lobe = &fit->lobe[i];
        int at = 1 + 4 * i, next = 1;
        low[at] = -0.9 * lobe->amplitude;
        high[at] = fmax(0, WEFT_LARGEST_AMPLITUDE - lobe->amplitude);
        for (int k = 0; k < 3; k++) {
            if (k == weft_lobe_fixed(lobe))
                continue;
            low[at + next] = fmax(-0.5, -1.5 - lobe->c[k]);
            high[at + next] = fmin(0.5, 1.5 - lobe->c[k]);
            next++;
        }
        low[at + 3] = fmin(0, fmax(-1.2, -lobe->log_exponent));
        high[at + 3] = fmax(0, fmin(1.2, log(options->max_exponent) - lobe->log_exponent));
    }
    for (int p = 1 + 4 * fit->lobe_count; p < n; p++) {
        low[p] = -0.3;
        high[p] = 0.3;
    }
}

static void apply_step(const double *d, int n, weft_fit *fit)
{
    fit->diffuse = fmax(0, fit->diffuse + d[0]);
    for (int i = 0; i < fit->lobe_count; i++) {
        weft_fit_lobe *lobe = &fit->lobe[i];
        const double *own = d + 1 + 4 * i;
        int fixed = weft_lobe_fixed(lobe), next = 1;
        lobe->amplitude = fmax(0, lobe->amplitude + own[0]);
        for (int k = 0; k < 3; k++)
            lobe->c[k] += k == fixed ? 0 : own[next++];
        lobe->log_exponent = fmax(0, lobe->log_exponent + own[3]);
        normalise_lobe(lobe);
    }
    if (n > 1 + 4 * fit->lobe_count)
        rotate_frame(d + 1 + 4 * fit->lobe_count, &fit->frame);
}

/* The damped step from `normal`; false where there is none. */
static bool make_step(const weft_normal *normal, double damping, const weft_fit_options *options, weft_fit *fit)
{
    int n = normal->n;
    double h[WEFT_SOLVE_MAX * WEFT_SOLVE_MAX], low[WEFT_SOLVE_MAX], high[WEFT_SOLVE_MAX], d[WEFT_SOLVE_MAX] = {0};
    double trace = 0;
    memcpy(h, normal->h, sizeof h);
    for (int p = 0; p < n; p++)
        trace += h[p * n + p];
    for (int p = 0; p < n; p++)
        h[p * n + p] += damping * h[p * n + p] + 1e-10 * trace + 1e-300;
    step_bounds(fit, options, n, low, high);
    if (!weft_solve_box(n, h, normal->g, low, high, d))
        return false;
    for (int p = 0; p < n; p++) {
        if (!isfinite(d[p]))
            return false;
    }
    apply_step(d, n, fit);
    return fit->frame.normal.z >= LEAST_TILT_COSINE;
}

/* A lobe may lose nine tenths of its strength in one pass, not more: it could not come back. */
static void least_amplitudes(const weft_fit *fit, double *least)
{
    for (int i = 0; i < fit->lobe_count; i++)
        least[i] = 0.1 * fit->lobe[i].amplitude;
}

static void refine(const weft_bundle *bundle, const weft_samples *samples, int channel, const weft_fit_options *options,
                   weft_fit_workspace *workspace, double damping)
{
    weft_trial *now = &workspace->trial[0], *next = &workspace->trial[1];
    double enough = 1e-10 * samples->energy[channel];
    while (now->fit.passes < options->max_passes && now->residual > enough && damping < 1e5) {
        weft_normal normal;
        weft_normal_of_trial(bundle, options->table, options->fit_frame, now, &normal);
        bool accepted = false, converged = false;
        while (!accepted && now->fit.passes < options->max_passes && damping < 1e5) {
            next->fit = now->fit;
            if (make_step(&normal, damping, options, &next->fit)) {
                double least[WEFT_GRAM_LOBES] = {0};
                least_amplitudes(&next->fit, least);
                run_pass(bundle, samples, channel, options, now->table, next);
                weft_trial_solve_linear(bundle, options->table, least, next);
                accepted = next->residual < now->residual;
            }
            now->fit.passes = next->fit.passes;
            damping *= accepted ? 0.2 : 6;
        }
        if (accepted) {
            converged = now->residual - next->residual < options->tolerance * now->residual;
            weft_trial swap = *now;
            *now = *next;
            *next = swap;
        }
        if (converged || !accepted)
            break;
        damping = fmax(damping, 1e-6);
    }
}

/* Amplitudes of a start: the best for T = 1, then with T eliminated. A vanished lobe keeps enough to be moved. */
static void solve_start(const weft_bundle *bundle, const weft_fit_options *options, weft_trial *trial)
{
    double least[WEFT_GRAM_LOBES] = {0}, strength[WEFT_LINEAR_MAX] = {0}, energy = 0;
    for (int view = 0; view < bundle->view_count; view++) {
        energy += trial->linear[view].square;
        for (int j = 0; j <= trial->fit.lobe_count; j++)
            strength[j] += trial->linear[view].gram[j][j];
    }
    for (int i = 0; i < trial->fit.lobe_count; i++)
        least[i] = strength[1 + i] > 1e-6 * strength[0] ? 0.02 * sqrt(energy / strength[1 + i]) : 0;
    trial->fit.diffuse = strength[0] > 0 ? 0.5 * sqrt(energy / strength[0]) : 0;
    for (int i = 0; i < trial->fit.lobe_count; i++)
        trial->fit.lobe[i].amplitude = least[i];
    trial->residual = INFINITY;
    weft_trial_solve_linear(bundle, false, least, trial);
    trial->residual = INFINITY;
    weft_trial_solve_linear(bundle, options->table, least, trial);
}

/* From shapes alone. */
static void begin_cold(const weft_bundle *bundle, const weft_samples *samples, int channel,
                       const weft_fit_options *options, weft_trial *trial)
{
    trial->fit.diffuse = 0;
    for (int i = 0; i < trial->fit.lobe_count; i++)
        trial->fit.lobe[i].amplitude = 0;
    run_pass(bundle, samples, channel, options, NULL, trial);
    solve_start(bundle, options, trial);
}

/* From a fit that is nearly right: its T keeps the sums free of cancellation. */
static void begin_warm(const weft_bundle *bundle, const weft_samples *samples, int channel,
                       const weft_fit_options *options, const double *table, weft_trial *trial)
{
    double least[WEFT_GRAM_LOBES] = {0};
    least_amplitudes(&trial->fit, least);
    run_pass(bundle, samples, channel, options, table, trial);
    weft_trial_solve_linear(bundle, options->table, least, trial);
}

/* T of views in which nothing was learnt: the mean of the others. */
static void fill_unseen(const weft_bundle *bundle, const weft_trial *trial, double *table)
{
    double sum = 0;
    int seen = 0;
    for (int view = 0; view < bundle->view_count; view++) {
        if (trial->linear[view].gram[0][0] > 0) {
            sum += trial->table[view];
            seen++;
        }
    }
    for (int view = 0; view < bundle->view_count; view++)
        table[view] = trial->linear[view].gram[0][0] > 0 ? trial->table[view] : seen ? sum / seen : 1;
}

static void finish(const weft_bundle *bundle, const weft_fit_options *options, const weft_trial *trial, weft_fit *fit,
                   double *table)
{
    *fit = trial->fit;
    fit->residual = trial->residual;
    fill_unseen(bundle, trial, table);
    for (int view = 0; !options->table && view < bundle->view_count; view++)
        table[view] = 1;
}

/* Nothing to fit: black, or no samples at all. */
static bool finish_empty(const weft_bundle *bundle, const weft_samples *samples, int channel, weft_fit *fit,
                         double *table)
{
    if (samples->energy[channel] > 0 && samples->valid_count > 0)
        return false;
    *fit = (weft_fit){.lobe_count = fit->lobe_count, .frame = fit->frame};
    for (int i = 0; i < fit->lobe_count; i++)
        fit->lobe[i] = (weft_fit_lobe){.c = {0, 0, 1}};
    for (int view = 0; view < bundle->view_count; view++)
        table[view] = 1;
    return true;
}

void weft_fit_refine(const weft_bundle *bundle, const weft_samples *samples, int channel,
                     const weft_fit_options *options, weft_fit_workspace *workspace, weft_fit *fit, double *table)
{
    if (finish_empty(bundle, samples, channel, fit, table))
        return;
    weft_trial *now = &workspace->trial[0];
    now->fit = *fit;
    now->fit.passes = 0;
    begin_warm(bundle, samples, channel, options, table, now);
    refine(bundle, samples, channel, options, workspace, 0.01);
    finish(bundle, options, now, fit, table);
}

/* ---- Starts ---- */

static const weft_fit_lobe mirror_start = {.c = {-0.95, -0.9, 1}, .log_exponent = 2.0794};
static const weft_fit_lobe retro_start = {.c = {0.9, 0.95, 1}, .log_exponent = 2.0794};
static const weft_fit_lobe broad_start = {.c = {-0.1, -0.15, 1}, .log_exponent = 0.4055};

enum { START_COUNT = 3 };

/* Start number `index`: the mirror and a broad lobe; the same thrown back to the light; both directions. */
static void place_start(int index, int lobe_count, weft_fit *fit)
{
    const weft_fit_lobe *order[START_COUNT][WEFT_GRAM_LOBES] = {{&mirror_start, &broad_start, &retro_start},
                                                                {&retro_start, &broad_start, &mirror_start},
                                                                {&broad_start, &retro_start, &mirror_start}};
    fit->lobe_count = lobe_count;
    for (int i = 0; i < lobe_count; i++) {
        fit->lobe[i] = *order[index][i];
        if (index == 2 && i == 2)
            fit->lobe[i].log_exponent += 1.4;
    }
}

void weft_fit_cold(const weft_bundle *bundle, const weft_samples *samples, int channel, const weft_fit_options *options,
                   weft_fit_workspace *workspace, const weft_frame *frame, weft_fit *fit, double *table)
{
    *fit = (weft_fit){.frame = *frame, .lobe_count = options->lobe_count};
    if (finish_empty(bundle, samples, channel, fit, table))
        return;
    weft_trial *now = &workspace->trial[0];
    weft_fit best = {.residual = INFINITY};
    weft_fit_options coarse = *options;
    coarse.coarse = true;
    coarse.tolerance = fmax(options->tolerance, 1e-3);
    int passes = 0;
    for (int start = 0; start < (options->lobe_count ? START_COUNT : 1); start++) {
        now->fit = (weft_fit){.frame = *frame};
        place_start(start, options->lobe_count, &now->fit);
        begin_cold(bundle, samples, channel, &coarse, now);
        refine(bundle, samples, channel, &coarse, workspace, 0.1);
        passes += (now->fit.passes + 3) / 4;
        if (now->residual < best.residual) {
            best = now->fit;
            best.residual = now->residual;
            memcpy(workspace->table, now->table, (size_t)bundle->view_count * sizeof *now->table);
        }
    }
    now->fit = best;
    now->fit.passes = passes;
    begin_warm(bundle, samples, channel, options, workspace->table, now);
    weft_fit_options full = *options;
    full.max_passes += passes;
    refine(bundle, samples, channel, &full, workspace, 0.01);
    finish(bundle, options, now, fit, table);
}
