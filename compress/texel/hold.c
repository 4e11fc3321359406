/* Models that are brighter between their samples, or beyond them, than any data speak for: see compress/texel/peak.h.
 */
#include "compress/texel/parts.h"

#include <math.h>
#include <stdlib.h>

#define COARSE_RAD 1.0
#define FINE_RAD 0.07

/* ---- What it needs ---- */

weft_code weft_texel_hold_create(weft_texel_fitter *fitter, weft_error *error)
{
    const weft_bundle *bundle = &fitter->bundle;
    WEFT_TRY(weft_peak_net_create(bundle->view, bundle->view_count, COARSE_RAD, &fitter->net[0], error));
    WEFT_TRY(weft_peak_net_create(bundle->view, bundle->view_count, FINE_RAD, &fitter->net[1], error));
    if (fitter->light_count == 0)
        return WEFT_OK;
    return weft_peak_lights_create(bundle->distinct, fitter->light_count, &fitter->peak_lights, error);
}

void weft_texel_hold_free(weft_texel_fitter *fitter)
{
    weft_peak_net_free(&fitter->net[0]);
    weft_peak_net_free(&fitter->net[1]);
    weft_peak_lights_free(&fitter->peak_lights);
}

/* ---- The limit ---- */

void weft_texel_limit(weft_texel_fitter *fitter)
{
    for (int channel = 0; channel < WEFT_CHANNELS; channel++) {
        float r, f, cosine;
        fitter->kernels->brightest(&fitter->bundle, &fitter->samples, channel, &r, &f, &cosine);
        fitter->most[channel] = (weft_peak){cosine > 0 ? WEFT_BRIGHTEST_MULTIPLE * (double)(r / cosine) : 0,
                                            WEFT_BRIGHTEST_MULTIPLE * (double)f};
    }
}

/* ---- Holding ---- */

/* T as it will be read into the first half of `factor`, and S on its grid. */
static weft_peak_tables decode_tables(weft_texel_fitter *fitter, int channel)
{
    int views = fitter->bundle.view_count;
    const uint8_t *code = fitter->now.code + (size_t)channel * (size_t)views;
    for (int view = 0; view < views; view++)
        fitter->factor[view] = weft_table_of_code(code[view]);
    if (fitter->light_count == 0)
        return (weft_peak_tables){fitter->factor, NULL};
    const uint8_t *light = fitter->now.light_code + (size_t)channel * (size_t)fitter->light_count;
    for (int l = 0; l < fitter->light_count; l++)
        fitter->decoded_light[l] = weft_table_of_code(light[l]);
    weft_peak_lights_set(&fitter->peak_lights, fitter->decoded_light);
    return (weft_peak_tables){fitter->factor, &fitter->peak_lights};
}

static bool exceeds(weft_peak peak, weft_peak most)
{
    return !(peak.r <= most.r && peak.f <= most.f);
}

static void lower_table(weft_texel_fitter *fitter, int channel, weft_peak most)
{
    int views = fitter->bundle.view_count;
    uint8_t *code = fitter->now.code + (size_t)channel * (size_t)views;
    double *t = fitter->factor, *factor = fitter->factor + views;
    weft_peak_factors(&fitter->net[1], most, factor);
    for (int view = 0; view < views; view++)
        if (factor[view] < 1)
            code[view] = (uint8_t)floor(255 * sqrt(t[view] * factor[view]));
}

/* All terms times `share`, rounded. */
static void lower_terms(weft_texel_fitter *fitter, int channel, double share)
{
    weft_fit *fit = &fitter->now.as_read[channel];
    weft_frame frame = fit->frame;
    fit->diffuse *= share;
    for (int i = 0; i < fit->lobe_count; i++)
        fit->lobe[i].amplitude *= share;
    weft_pack_rounded(fit, fitter->samples.scale, &fitter->now.packed[channel]);
    *fit = weft_unpack(&fitter->now.packed[channel], fit->lobe_count, &frame, fitter->samples.scale);
}

void weft_texel_hold(weft_texel_fitter *fitter, int channel, bool may_lower_table)
{
    weft_peak most = fitter->most[channel];
    weft_fit *fit = &fitter->now.as_read[channel];
    weft_peak_tables tables = decode_tables(fitter, channel);
    if (!exceeds(weft_peak_of_fit(&fitter->net[0], fit, &tables), most))
        return;
    weft_peak peak = weft_peak_of_fit(&fitter->net[1], fit, &tables);
    if (!exceeds(peak, most))
        return;
    fitter->now.held = true;
    if (may_lower_table) {
        lower_table(fitter, channel, most);
        return;
    }
    /* A half float of C errs by N 2^-12 in C^N: once more where rounding has undone it. */
    for (int round = 1; round <= 4 && exceeds(peak, most); round++) {
        lower_terms(fitter, channel, fmin(most.r / peak.r, most.f / peak.f) * (1 - 0.02 * round * round));
        peak = weft_peak_of_fit(&fitter->net[1], fit, &tables);
    }
}
