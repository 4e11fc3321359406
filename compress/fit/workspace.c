#include "compress/fit/workspace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void *allocate_rows(size_t rows, size_t stride, size_t size)
{
    /* aligned_alloc takes whole multiples of the alignment. */
    size_t bytes = (rows * stride * size + 63) / 64 * 64;
    void *result = aligned_alloc(64, bytes);
    if (result)
        memset(result, 0, bytes);
    return result;
}

static bool create_trial(int view_stride, weft_trial *trial)
{
    size_t stride = (size_t)view_stride;
    trial->pass_table = allocate_rows(1, stride, sizeof *trial->pass_table);
    trial->table = allocate_rows(1, stride, sizeof *trial->table);
    trial->linear = allocate_rows(WEFT_LINEAR_ROWS, stride, sizeof *trial->linear);
    trial->sums = allocate_rows(WEFT_GRAM_PRODUCTS, stride, sizeof *trial->sums);
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
    size_t views = (size_t)bundle->view_stride;
    workspace->table = allocate_rows(1, views, sizeof *workspace->table);
    workspace->scratch[0] = allocate_rows(2, views, sizeof *workspace->scratch[0]);
    workspace->model = allocate_rows((size_t)bundle->sample_count + WEFT_STRIP_LANES, 1, sizeof *workspace->model);
    weft_screen *screen = &workspace->screen;
    float **by_sample[] = {&screen->error, &screen->model, &screen->square};
    screen->energy = allocate_rows(1, views, sizeof *screen->energy);
    bool complete = workspace->table && workspace->scratch[0] && workspace->model && screen->energy;
    for (int i = 0; i < 3; i++) {
        *by_sample[i] = allocate_rows((size_t)bundle->sample_count + WEFT_STRIP_LANES, 1, sizeof **by_sample[i]);
        complete = complete && *by_sample[i];
    }
    for (int i = 0; i < WEFT_TRIALS; i++)
        complete = create_trial(bundle->view_stride, &workspace->trial[i]) && complete;
    if (!complete) {
        weft_fit_workspace_free(workspace);
        return weft_fail_memory(error, "workspace of a fit", views * 2048);
    }
    workspace->scratch[1] = workspace->scratch[0] + views;
    *result = workspace;
    return WEFT_OK;
}

void weft_fit_workspace_free(weft_fit_workspace *workspace)
{
    if (!workspace)
        return;
    for (int i = 0; i < WEFT_TRIALS; i++)
        free_trial(&workspace->trial[i]);
    free(workspace->table);
    free(workspace->scratch[0]);
    free(workspace->model);
    free(workspace->screen.error);
    free(workspace->screen.model);
    free(workspace->screen.square);
    free(workspace->screen.energy);
    free(workspace);
}

void weft_trial_swap(weft_trial *a, weft_trial *b)
{
    weft_trial swap = *a;
    *a = *b;
    *b = swap;
}

static void look(const weft_bundle *bundle, const weft_samples *samples, int channel, weft_part part, weft_trial *trial)
{
    WEFT_DISPATCH(weft_gram_accumulate)
    (bundle, samples->cosine, samples->value[channel], &trial->point, trial->pass_table, part, trial->sums);
    weft_trial_digest(bundle, trial);
    trial->fit.passes += 1;
}

void weft_workspace_pass(const weft_bundle *bundle, const weft_samples *samples, int channel,
                         const weft_fit_options *options, const float *table, weft_trial *trial)
{
    for (int view = 0; view < bundle->view_count; view++)
        trial->pass_table[view] = table ? table[view] : 0.0f;
    if (!options->table) {
        for (int view = 0; view < bundle->view_count; view++)
            trial->pass_table[view] = 1;
    }
    trial->most = options->max_amplitude;
    trial->point = weft_gram_point_of_fit(&trial->fit);
    /* The digest must use the very numbers of the pass. */
    trial->fit.diffuse = (double)trial->point.diffuse;
    for (int i = 0; i < trial->point.lobe_count; i++)
        trial->fit.lobe[i].amplitude = (double)trial->point.amplitude[i];
    trial->at = weft_linear_of_fit(&trial->fit);
    look(bundle, samples, channel, options->coarse ? WEFT_PART_COARSE : WEFT_PART_ALL, trial);
}

const float *weft_workspace_keep_table(const weft_bundle *bundle, weft_fit_workspace *workspace, const double *table)
{
    for (int view = 0; view < bundle->view_count; view++)
        workspace->table[view] = (float)table[view];
    return workspace->table;
}

bool weft_workspace_finish_empty(const weft_bundle *bundle, const weft_samples *samples, int channel, weft_fit *fit,
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

/* A lobe may lose nine tenths of its strength in one pass, not more: it could not come back. */
static void least_amplitudes(const weft_fit *fit, double *least)
{
    for (int i = 0; i < fit->lobe_count; i++)
        least[i] = 0.1 * fit->lobe[i].amplitude;
}

/* Amplitudes of a start: the best for T = 1, then with T eliminated. A vanished lobe keeps enough to be moved. */
static void solve_start(const weft_bundle *bundle, const weft_fit_options *options, weft_trial *trial)
{
    double least[WEFT_GRAM_LOBES] = {0}, energy = trial->energy;
    const double *strength = trial->strength;
    for (int i = 0; i < trial->fit.lobe_count; i++)
        least[i] = strength[1 + i] > 1e-6 * strength[0] ? 0.02 * sqrt(energy / strength[1 + i]) : 0;
    trial->fit.diffuse = strength[0] > 0 ? 0.5 * sqrt(energy / strength[0]) : 0;
    for (int i = 0; i < trial->fit.lobe_count; i++)
        trial->fit.lobe[i].amplitude = least[i];
    weft_trial_solve_linear(bundle, false, least, trial);
    weft_trial_solve_linear(bundle, options->table, least, trial);
}

void weft_workspace_begin_cold(const weft_bundle *bundle, const weft_samples *samples, int channel,
                               const weft_fit_options *options, weft_trial *trial)
{
    trial->fit.diffuse = 0;
    for (int i = 0; i < trial->fit.lobe_count; i++)
        trial->fit.lobe[i].amplitude = 0;
    weft_workspace_pass(bundle, samples, channel, options, NULL, trial);
    solve_start(bundle, options, trial);
}

void weft_workspace_begin_warm(const weft_bundle *bundle, const weft_samples *samples, int channel,
                               const weft_fit_options *options, const float *table, weft_trial *trial)
{
    double least[WEFT_GRAM_LOBES] = {0};
    least_amplitudes(&trial->fit, least);
    weft_workspace_pass(bundle, samples, channel, options, table, trial);
    weft_trial_solve_linear(bundle, options->table, least, trial);
}

void weft_workspace_finish(const weft_bundle *bundle, const weft_fit_options *options, weft_trial *trial, weft_fit *fit,
                           double *table)
{
    const double least[WEFT_GRAM_LOBES] = {0};
    weft_trial_solve_linear(bundle, options->table, least, trial);
    *fit = trial->fit;
    fit->residual = trial->residual;
    for (int view = 0; view < bundle->view_count; view++)
        table[view] = 1;
    if (options->table)
        weft_trial_take_table(bundle, trial, table);
}
