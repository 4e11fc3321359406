/* Models that are brighter between their samples, or beyond them, than any data speak for: see compress/texel/peak.h.
 */
#include "compress/texel/parts.h"

#include <math.h>
#include <stdlib.h>

#define COARSE_RAD 1.0
#define FINE_RAD 0.07
#define FINE_RAD_OF_ONE 0.14 /* where T is the same everywhere: half the time, the same texels held */
#define FOR_ROUNDING 0.97

/* ---- What it needs ---- */

weft_code weft_texel_hold_create(weft_texel_fitter *fitter, weft_error *error)
{
    const weft_bundle *bundle = &fitter->bundle;
    /* Without T all views are alike, however many there are. */
    const weft_vec3 any = {0, 0, 1}, *view = fitter->source->options.table ? bundle->view : &any;
    int view_count = fitter->source->options.table ? bundle->view_count : 1;
    WEFT_TRY(weft_peak_net_create(view, view_count, COARSE_RAD, &fitter->net[0], error));
    WEFT_TRY(
        weft_peak_net_create(view, view_count, view_count > 1 ? FINE_RAD : FINE_RAD_OF_ONE, &fitter->net[1], error));
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
    const double *table = fitter->source->options.table ? fitter->factor : NULL;
    for (int view = 0; view < views; view++)
        fitter->factor[view] = weft_table_of_code(code[view]);
    if (fitter->light_count == 0)
        return (weft_peak_tables){table, NULL};
    const uint8_t *light = fitter->now.light_code + (size_t)channel * (size_t)fitter->light_count;
    for (int l = 0; l < fitter->light_count; l++)
        fitter->decoded_light[l] = weft_table_of_code(light[l]);
    weft_peak_lights_set(&fitter->peak_lights, fitter->decoded_light);
    return (weft_peak_tables){table, &fitter->peak_lights};
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

/* Fits again, from the starts of the grey samples and then from what was fitted; no term may be brighter than
 * `most`. */
static void fit_dimmer(weft_texel_fitter *fitter, int channel, const weft_fit_options *options, int round, double most)
{
    weft_fit *fit = &fitter->now.as_read[channel], dimmer = *fit;
    weft_fit_options own = *options;
    weft_samples lit = weft_texel_samples_as_lit(fitter, channel);
    uint8_t *code = fitter->now.code + (size_t)channel * (size_t)fitter->bundle.view_count;
    own.max_amplitude = most;
    if (round == 0) {
        weft_starts starts = fitter->frames.starts[false].surface;
        for (int i = 0; i < WEFT_FINALISTS; i++)
            starts.start[own.lobe_count][i].frame = fit->frame;
        weft_fit_from_starts(&fitter->bundle, &lit, channel, &own, fitter->workspace, &starts, &dimmer, fitter->table);
    } else {
        weft_fit_refine(&fitter->bundle, &lit, channel, &own, fitter->workspace, &dimmer, fitter->table);
    }
    weft_pack_channel(&fitter->bundle, &lit, channel, &own, fitter->workspace, &dimmer, fitter->table,
                      &fitter->now.packed[channel], code);
    *fit = weft_unpack(&fitter->now.packed[channel], own.lobe_count, &dimmer.frame, fitter->samples.scale);
}

bool weft_texel_exceeds(weft_texel_fitter *fitter, int channel)
{
    weft_peak_tables tables = decode_tables(fitter, channel);
    const weft_fit *fit = &fitter->now.as_read[channel];
    return exceeds(weft_peak_of_fit(&fitter->net[0], fit, &tables), fitter->most[channel]) &&
           exceeds(weft_peak_of_fit(&fitter->net[1], fit, &tables), fitter->most[channel]);
}

bool weft_texel_is_too_bright(weft_texel_fitter *fitter)
{
    bool any = false;
    for (int channel = 0; channel < WEFT_CHANNELS; channel++)
        any = any || weft_texel_exceeds(fitter, channel);
    return any;
}

void weft_texel_hold(weft_texel_fitter *fitter, int channel, const weft_fit_options *options)
{
    weft_peak most = fitter->most[channel];
    weft_fit *fit = &fitter->now.as_read[channel];
    if (!weft_texel_exceeds(fitter, channel))
        return;
    weft_peak_tables tables = decode_tables(fitter, channel);
    weft_peak peak = weft_peak_of_fit(&fitter->net[1], fit, &tables);
    fitter->now.held = true;
    if (options->table) {
        lower_table(fitter, channel, most);
        return;
    }
    /* Terms may add up. */
    double term = FOR_ROUNDING * fmin(most.r, most.f);
    for (int round = 0; round < 4 && options->lobe_count > 0 && exceeds(peak, most); round++) {
        fit_dimmer(fitter, channel, options, round, term);
        peak = weft_peak_of_fit(&fitter->net[1], fit, &tables);
        term *= 0.75;
    }
    /* A half float of C errs by N 2^-12 in C^N: once more where rounding has undone it. */
    for (int round = 1; round <= 4 && exceeds(peak, most); round++) {
        lower_terms(fitter, channel, fmin(most.r / peak.r, most.f / peak.f) * (1 - 0.02 * round * round));
        peak = weft_peak_of_fit(&fitter->net[1], fit, &tables);
    }
}
