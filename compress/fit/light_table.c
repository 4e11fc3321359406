#include "compress/fit/light_table.h"

#include "compress/fit/workspace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PASSES_A_ROUND = 3, TURNS_A_ROUND = 4 };

#define MOST_EXTRAPOLATION 8 /* steps ahead */
#define PRIOR 0.003f         /* of S = 1, as a part of the mean energy of a light */

static float *allocate_floats(size_t count)
{
    size_t bytes = (count * sizeof(float) + 63) / 64 * 64;
    float *result = aligned_alloc(64, bytes);
    if (result)
        memset(result, 0, bytes);
    return result;
}

weft_code weft_light_workspace_create(const weft_bundle *bundle, weft_light_workspace *result, weft_error *error)
{
    size_t lights = (size_t)bundle->light_count, views = (size_t)bundle->view_stride;
    size_t samples = (size_t)bundle->sample_count + WEFT_STRIP_LANES, cells = lights * views;
    *result = (weft_light_workspace){.separable = {bundle->light_count, bundle->view_stride, allocate_floats(cells + 1),
                                                   allocate_floats(cells + 1), PRIOR},
                                     .cosine = allocate_floats(samples),
                                     .table = allocate_floats(views + 1),
                                     .light = allocate_floats(2 * lights + 1),
                                     .before = calloc(3 * lights + views + 1, sizeof *result->before)};
    if (!result->separable.square || !result->separable.product || !result->cosine || !result->table ||
        !result->light || !result->before)
        return weft_fail_memory(error, "light table of a texel", (samples + 2 * cells) * sizeof *result->cosine);
    result->energy = result->light + lights;
    result->step = result->before + lights;
    result->light_best = result->step + lights;
    result->table_best = result->light_best + lights;
    return WEFT_OK;
}

void weft_light_workspace_free(weft_light_workspace *workspace)
{
    free(workspace->separable.square);
    free(workspace->separable.product);
    free(workspace->cosine);
    free(workspace->table);
    free(workspace->light);
    free(workspace->before);
    *workspace = (weft_light_workspace){0};
}

weft_samples weft_light_apply(const weft_bundle *bundle, const weft_samples *samples, const double *light,
                              float *cosine)
{
    weft_samples lit = *samples;
    for (int i = 0; i < bundle->sample_count; i++)
        cosine[i] = samples->cosine[i] * (float)light[bundle->light_of[i]];
    lit.cosine = cosine;
    return lit;
}

/* Where nothing was learnt S is the mean of the others; then all are scaled to a mean of 1. */
static void settle(const float *energy, int count, float *light)
{
    float sum = 0, total = 0;
    int seen = 0;
    for (int l = 0; l < count; l++)
        total += energy[l];
    float negligible = 1e-9f * total / (float)count;
    for (int l = 0; l < count; l++) {
        if (energy[l] > negligible) {
            sum += light[l];
            seen++;
        }
    }
    for (int l = 0; l < count; l++)
        light[l] = sum > 0 && energy[l] > negligible ? light[l] * (float)seen / sum : 1;
}

static void fill_separable(const weft_bundle *bundle, const weft_samples *samples, int channel, const float *model,
                           weft_separable *to)
{
    size_t bytes = (size_t)to->light_count * (size_t)to->view_stride * sizeof *to->square;
    memset(to->square, 0, bytes);
    memset(to->product, 0, bytes);
    for (int i = 0; i < bundle->sample_count; i++) {
        int at = bundle->light_of[i] * to->view_stride + bundle->view_of[i];
        to->square[at] += model[i] * model[i];
        to->product[at] += model[i] * samples->value[channel][i];
    }
}

/* T and S for the lobes of `fit`, from `table` and `light`, into `own`. Taken in turn they creep towards each other,
 * but cost next to nothing once the samples have been summed up. */
static void separate(const weft_bundle *bundle, const weft_samples *samples, int channel,
                     const weft_fit_options *options, weft_fit_workspace *workspace, const weft_fit *fit,
                     const double *table, const double *light, weft_light_workspace *own)
{
    const float *model = weft_fit_evaluate(bundle, samples, workspace, fit);
    fill_separable(bundle, samples, channel, model, &own->separable);
    for (int view = 0; view < bundle->view_count; view++)
        own->table[view] = (float)table[view];
    for (int l = 0; l < bundle->light_count; l++)
        own->light[l] = (float)light[l];
    workspace->trial[0].kernels->separate(&own->separable, options->table, TURNS_A_ROUND, own->table, own->light,
                                          own->energy);
    settle(own->energy, bundle->light_count, own->light);
}

/* The next S from where the fit leads it: S + step, corrected by what the round before has shown of how steps shrink
 * (Anderson 1965, one round of memory). */
static void advance(weft_light_workspace *own, int count, bool remembers, double *light)
{
    double along = 0, length = 0;
    for (int l = 0; remembers && l < count; l++) {
        double step = (double)own->light[l] - light[l], change = step - own->step[l];
        along += (double)own->energy[l] * change * step;
        length += (double)own->energy[l] * change * change;
    }
    double share = length > 0 ? fmin(fmax(along / length, -MOST_EXTRAPOLATION), 1) : 0;
    for (int l = 0; l < count; l++) {
        double step = (double)own->light[l] - light[l];
        double next = light[l] + step;
        if (remembers)
            next -= share * (light[l] - own->before[l] + step - own->step[l]);
        own->before[l] = light[l];
        own->step[l] = step;
        light[l] = fmax(0, next);
    }
}

/* A round that went too far leaves more than the one before: what leaves least is kept. */
static void keep(const weft_bundle *bundle, const weft_fit *fit, double residual, const double *table,
                 const double *light, weft_light_workspace *own)
{
    own->least = residual;
    own->best = *fit;
    memcpy(own->table_best, table, (size_t)bundle->view_count * sizeof *table);
    memcpy(own->light_best, light, (size_t)bundle->light_count * sizeof *light);
}

weft_samples weft_light_refine(const weft_bundle *bundle, const weft_samples *samples, int channel,
                               const weft_fit_options *options, int most_rounds, weft_fit_workspace *workspace,
                               weft_light_workspace *own, weft_fit *fit, double *table, double *light)
{
    weft_fit_options few = *options;
    few.max_passes = PASSES_A_ROUND;
    double before = INFINITY;
    int passes = 0;
    bool remembers = false;
    for (int round = 0;; round++) {
        weft_samples lit = weft_light_apply(bundle, samples, light, own->cosine);
        weft_fit_refine(bundle, &lit, channel, &few, workspace, fit, table);
        passes += fit->passes;
        double residual = options->table ? weft_trial_moderate_residual(bundle, &workspace->trial[0]) : fit->residual;
        if (round == 0 || residual < own->least)
            keep(bundle, fit, residual, table, light, own);
        double gain = before - fit->residual;
        if (round == most_rounds || (gain >= 0 && gain <= options->tolerance * fit->residual))
            break;
        remembers = round > 0 && gain > 0;
        before = fit->residual;
        separate(bundle, samples, channel, options, workspace, fit, table, light, own);
        advance(own, bundle->light_count, remembers, light);
        for (int view = 0; view < bundle->view_count; view++)
            table[view] = (double)own->table[view];
    }
    *fit = own->best;
    fit->passes = passes;
    memcpy(table, own->table_best, (size_t)bundle->view_count * sizeof *table);
    memcpy(light, own->light_best, (size_t)bundle->light_count * sizeof *light);
    return weft_light_apply(bundle, samples, light, own->cosine);
}
