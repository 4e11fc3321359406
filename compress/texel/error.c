/* How far a texel, as it will be read, is from its samples. */
#include "compress/texel/parts.h"

static void tally_channel(weft_texel_fitter *fitter, int channel, const float *model)
{
    const weft_bundle *bundle = &fitter->bundle;
    const weft_samples *samples = &fitter->samples;
    for (int i = 0; i < bundle->sample_count; i++) {
        float cosine = samples->cosine[i];
        if (!(cosine > 0))
            continue;
        float scale = (float)samples->scale * bundle->light[2][i] / cosine;
        weft_error_tally_add(fitter->tally, samples->value[channel][i] * scale,
                             model[i] * fitter->decoded[bundle->view_of[i]] * scale);
    }
}

weft_error_sums weft_texel_measure(weft_texel_fitter *fitter, bool tallied)
{
    const weft_bundle *bundle = &fitter->bundle;
    weft_error_sums sums = {0};
    for (int channel = 0; channel < WEFT_CHANNELS; channel++) {
        const uint8_t *code = fitter->code + (size_t)channel * (size_t)bundle->view_count;
        for (int view = 0; view < bundle->view_count; view++)
            fitter->decoded[view] = (float)weft_table_of_code(code[view]);
        const float *model = weft_fit_evaluate(bundle, &fitter->samples, fitter->workspace, &fitter->as_read[channel]);
        fitter->kernels->compare(bundle, &fitter->samples, channel, model, fitter->decoded, &sums);
        if (tallied)
            tally_channel(fitter, channel, model);
    }
    return sums;
}
