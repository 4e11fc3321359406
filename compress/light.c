#include "compress/light.h"

#include "compress/workspace.h"

#include <math.h>
#include <string.h>

enum { MOST_ROUNDS = 12, PASSES_A_ROUND = 2 };

#define MOST_EXTRAPOLATION 8 /* steps ahead */

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
static void settle(const double *energy, int count, double *light)
{
    double sum = 0, total = 0;
    int seen = 0;
    for (int l = 0; l < count; l++)
        total += energy[l];
    double negligible = 1e-9 * total / count;
    for (int l = 0; l < count; l++) {
        if (energy[l] > negligible) {
            sum += light[l];
            seen++;
        }
    }
    for (int l = 0; l < count; l++)
        light[l] = sum > 0 && energy[l] > negligible ? light[l] * seen / sum : 1;
}

/* S for given fit and T: least squares, light by light, into `solved`. */
static void solve_light(const weft_bundle *bundle, const weft_samples *samples, int channel,
                        weft_fit_workspace *workspace, const weft_fit *fit, const double *table, double *solved)
{
    const float *model = weft_fit_evaluate(bundle, samples, workspace, fit);
    double *energy = workspace->light_energy;
    for (int l = 0; l < bundle->light_count; l++)
        solved[l] = energy[l] = 0;
    for (int i = 0; i < bundle->sample_count; i++) {
        double f = table[bundle->view_of[i]] * (double)model[i];
        solved[bundle->light_of[i]] += f * (double)samples->value[channel][i];
        energy[bundle->light_of[i]] += f * f;
    }
    for (int l = 0; l < bundle->light_count; l++)
        solved[l] = energy[l] > 0 ? fmax(0, solved[l] / energy[l]) : 1;
    settle(energy, bundle->light_count, solved);
}

/* The next S from where the fit leads it: S + step, corrected by what the round before has shown of how steps shrink
 * (Anderson 1965, one round of memory). */
static void advance(weft_fit_workspace *workspace, int count, bool remembers, double *light)
{
    double *before = workspace->light_before, *step_before = workspace->light_step, along = 0, length = 0;
    for (int l = 0; remembers && l < count; l++) {
        double step = workspace->light[l] - light[l], change = step - step_before[l];
        along += workspace->light_energy[l] * change * step;
        length += workspace->light_energy[l] * change * change;
    }
    double share = length > 0 ? fmin(fmax(along / length, -MOST_EXTRAPOLATION), 1) : 0;
    for (int l = 0; l < count; l++) {
        double step = workspace->light[l] - light[l];
        double next = light[l] + step;
        if (remembers)
            next -= share * (light[l] - before[l] + step - step_before[l]);
        before[l] = light[l];
        step_before[l] = step;
        light[l] = fmax(0, next);
    }
}

/* A round that went too far leaves more than the one before: what left least is kept. */
static void keep_best(const weft_bundle *bundle, const weft_fit *fit, const double *table, const double *light,
                      weft_fit_workspace *workspace, weft_fit *best)
{
    if (!(fit->residual < best->residual))
        return;
    *best = *fit;
    memcpy(workspace->table_best, table, (size_t)bundle->view_count * sizeof *table);
    memcpy(workspace->light_best, light, (size_t)bundle->light_count * sizeof *light);
}

weft_samples weft_light_refine(const weft_bundle *bundle, const weft_samples *samples, int channel,
                               const weft_fit_options *options, weft_fit_workspace *workspace, float *cosine,
                               weft_fit *fit, double *table, double *light)
{
    weft_fit_options few = *options;
    few.max_passes = PASSES_A_ROUND;
    weft_fit best = {.residual = INFINITY};
    double before = INFINITY;
    int passes = 0;
    bool remembers = false;
    for (int round = 0;; round++) {
        weft_samples lit = weft_light_apply(bundle, samples, light, cosine);
        weft_fit_refine(bundle, &lit, channel, &few, workspace, fit, table);
        passes += fit->passes;
        keep_best(bundle, fit, table, light, workspace, &best);
        double gain = before - fit->residual;
        if (round == MOST_ROUNDS || (gain >= 0 && gain < options->tolerance * fit->residual))
            break;
        remembers = round > 0 && gain > 0;
        before = fit->residual;
        solve_light(bundle, samples, channel, workspace, fit, table, workspace->light);
        advance(workspace, bundle->light_count, remembers, light);
    }
    *fit = best;
    fit->passes = passes;
    memcpy(table, workspace->table_best, (size_t)bundle->view_count * sizeof *table);
    memcpy(light, workspace->light_best, (size_t)bundle->light_count * sizeof *light);
    return weft_light_apply(bundle, samples, light, cosine);
}
