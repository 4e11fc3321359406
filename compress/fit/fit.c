/* The options of a fit, what the number of samples allows, and the model at every sample. */
#include "compress/fit/workspace.h"

#include <math.h>

weft_fit_options weft_fit_default_options(void)
{
    return (weft_fit_options){.lobe_count = 2,
                              .table = true,
                              .max_exponent = 8192,
                              .max_amplitude = WEFT_LARGEST_AMPLITUDE,
                              .tolerance = 1e-3,
                              .max_passes = 40};
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

const float *weft_fit_evaluate(const weft_bundle *bundle, const weft_samples *samples, weft_fit_workspace *workspace,
                               const weft_fit *fit)
{
    weft_gram_point point = weft_gram_point_of_fit(fit);
    WEFT_DISPATCH(weft_gram_evaluate)(bundle, samples->cosine, &point, WEFT_PART_ALL, workspace->model);
    return workspace->model;
}
