/* The one-pass parts of a fit, the options, and what the number of samples allows. */
#include "compress/workspace.h"

#include <math.h>

weft_fit_options weft_fit_default_options(void)
{
    return (weft_fit_options){.lobe_count = 2, .table = true, .max_exponent = 512, .tolerance = 1e-3, .max_passes = 40};
}

int weft_fit_affordable_lobes(const weft_bundle *bundle, const weft_samples *samples, int wanted, bool table)
{
    uint8_t is_seen[WEFT_MATERIAL_MAX_VIEWS] = {0};
    int seen = 0;
    for (int i = 0; table && i < bundle->sample_count; i++)
        is_seen[bundle->view_of[i]] |= samples->cosine[i] > 0;
    for (int view = 0; table && view < bundle->view_count; view++)
        seen += is_seen[view];
    int parameters = (samples->valid_count - 4 * seen) / 4;
    int lobes = (parameters - 1) / 4;
    return lobes < 0 || parameters < 1 ? 0 : lobes < wanted ? lobes : wanted;
}

void weft_fit_table(const weft_bundle *bundle, const weft_samples *samples, int channel,
                    const weft_fit_options *options, weft_fit_workspace *workspace, const weft_fit *fit, double *table)
{
    weft_trial *trial = &workspace->trial[0];
    trial->fit = *fit;
    weft_workspace_pass(bundle, samples, channel, options, weft_workspace_keep_table(bundle, workspace, table), trial);
    weft_workspace_take_table(bundle, options, trial, table);
}

void weft_fit_amplitudes(const weft_bundle *bundle, const weft_samples *samples, int channel,
                         const weft_fit_options *options, weft_fit_workspace *workspace, const double *table,
                         unsigned frozen, weft_fit *fit)
{
    weft_trial *trial = &workspace->trial[0];
    double low[WEFT_LINEAR_MAX] = {0}, high[WEFT_LINEAR_MAX];
    weft_fit_options plain = *options;
    plain.table = true;
    trial->fit = *fit;
    weft_workspace_pass(bundle, samples, channel, &plain, NULL, trial);
    for (int j = 0; j <= fit->lobe_count; j++) {
        bool fixed = j > 0 && (frozen >> (j - 1) & 1);
        low[j] = fixed ? trial->fit.lobe[j - 1].amplitude : 0;
        high[j] = fixed ? low[j] : WEFT_LARGEST_AMPLITUDE;
    }
    weft_trial_solve_given_table(bundle, table, low, high, trial);
    *fit = trial->fit;
}

const float *weft_fit_evaluate(const weft_bundle *bundle, const weft_samples *samples, weft_fit_workspace *workspace,
                               const weft_fit *fit)
{
    weft_gram_point point = weft_gram_point_of_fit(fit);
    workspace->trial[0].kernels->evaluate(bundle, samples->cosine, &point, workspace->model);
    return workspace->model;
}

void weft_fit_model_energy(const weft_bundle *bundle, const weft_samples *samples, weft_fit_workspace *workspace,
                           const weft_fit *fit, double *energy)
{
    const float *model = weft_fit_evaluate(bundle, samples, workspace, fit);
    for (int view = 0; view < bundle->view_count; view++)
        energy[view] = 0;
    for (int i = 0; i < bundle->sample_count; i++)
        energy[bundle->view_of[i]] += (double)model[i] * (double)model[i];
}
