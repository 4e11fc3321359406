/* How far the model of a texel is from its samples. */
#include "compress/texel/parts.h"

/* In a level of many texels this share of them is enough for percentiles. */
enum { TALLIED_TEXELS = 1024 };

bool weft_texel_is_tallied(const weft_material_level *level, int x, int y)
{
    int stride = level->width * level->height / TALLIED_TEXELS;
    return stride < 2 || (y * level->width + x) % stride == 0;
}

static void tally_channel(weft_texel_fitter *fitter, int channel, const float *model, const float *table)
{
    const weft_bundle *bundle = &fitter->bundle;
    const weft_samples *samples = &fitter->samples;
    for (int i = 0; i < bundle->sample_count; i++) {
        float cosine = samples->cosine[i];
        if (!(cosine > 0))
            continue;
        float scale = (float)samples->scale * bundle->light[2][i] / cosine;
        weft_error_tally_add(fitter->tally, samples->value[channel][i] * scale,
                             model[i] * table[bundle->view_of[i]] * scale);
    }
}

weft_samples weft_texel_samples_as_lit(weft_texel_fitter *fitter, int channel)
{
    if (fitter->light_count == 0)
        return fitter->samples;
    const uint8_t *code = fitter->now.light_code + (size_t)channel * (size_t)fitter->light_count;
    for (int l = 0; l < fitter->light_count; l++)
        fitter->decoded_light[l] = weft_table_of_code(code[l]);
    return weft_light_apply(&fitter->bundle, &fitter->samples, fitter->decoded_light, fitter->lights.cosine);
}

/* The model of a channel at its samples, without T; T as it will be read goes into fitter->decoded. */
static const float *predict(weft_texel_fitter *fitter, int channel)
{
    const weft_bundle *bundle = &fitter->bundle;
    const uint8_t *code = fitter->now.code + (size_t)channel * (size_t)bundle->view_count;
    weft_samples lit = weft_texel_samples_as_lit(fitter, channel);
    for (int view = 0; view < bundle->view_count; view++)
        fitter->decoded[view] = (float)weft_table_of_code(code[view]);
    return weft_fit_evaluate(bundle, &lit, fitter->workspace, &fitter->now.as_read[channel]);
}

double weft_texel_weighted_error(weft_texel_fitter *fitter)
{
    const weft_bundle *bundle = &fitter->bundle;
    double sum = 0;
    for (int channel = 0; channel < WEFT_CHANNELS; channel++) {
        const float *model = predict(fitter, channel);
        for (int i = 0; i < bundle->sample_count; i++) {
            float error = fitter->samples.value[channel][i] - fitter->decoded[bundle->view_of[i]] * model[i];
            sum += (double)(error * error);
        }
    }
    return sum;
}

/* Whether all channels are but a diffuse term, as beside components: that is compared in one go. */
static bool is_flat(const weft_texel_fitter *fitter, float diffuse[WEFT_CHANNELS])
{
    static const uint8_t one = 255;
    size_t codes = WEFT_CHANNELS * (size_t)fitter->bundle.view_count;
    for (int channel = 0; channel < WEFT_CHANNELS; channel++) {
        if (fitter->now.as_read[channel].lobe_count > 0)
            return false;
        diffuse[channel] = (float)fitter->now.as_read[channel].diffuse;
    }
    for (size_t i = 0; i < codes; i++) {
        if (fitter->now.code[i] != one)
            return false;
    }
    return fitter->light_count == 0;
}

weft_error_sums weft_texel_measure(weft_texel_fitter *fitter, bool tallied)
{
    const weft_bundle *bundle = &fitter->bundle;
    weft_error_sums sums = {0};
    float diffuse[WEFT_CHANNELS];
    bool flat = is_flat(fitter, diffuse);
    if (flat)
        fitter->kernels->compare_flat(bundle, &fitter->samples, diffuse, &sums);
    for (int channel = 0; channel < WEFT_CHANNELS && (tallied || !flat); channel++) {
        const float *model = predict(fitter, channel);
        if (!flat)
            fitter->kernels->compare(bundle, &fitter->samples, channel, model, fitter->decoded, &sums);
        if (tallied)
            tally_channel(fitter, channel, model, fitter->decoded);
    }
    return sums;
}
