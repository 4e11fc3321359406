/* S of a texel's channels. */
#include "compress/texel/parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { GREY_ROUNDS = 12, CHANNEL_ROUNDS = 3 };

weft_code weft_texel_light_create(weft_texel_fitter *fitter, weft_error *error)
{
    size_t lights = (size_t)fitter->bundle.light_count, views = (size_t)fitter->bundle.view_count;
    fitter->light_count = fitter->bundle.light_count;
    fitter->light = calloc(3 * lights + views, sizeof *fitter->light);
    fitter->now.light_code = calloc(WEFT_CHANNELS * lights + 1, 1);
    fitter->kept.light_code = calloc(WEFT_CHANNELS * lights + 1, 1);
    if (!fitter->light || !fitter->now.light_code || !fitter->kept.light_code)
        return weft_fail_memory(error, "light table of a texel", (3 * lights + views) * sizeof *fitter->light);
    fitter->decoded_light = fitter->light + lights;
    fitter->grey_light = fitter->decoded_light + lights;
    fitter->lit.table = fitter->grey_light + lights;
    return weft_light_workspace_create(&fitter->bundle, &fitter->lights, error);
}

void weft_texel_light_free(weft_texel_fitter *fitter)
{
    weft_light_workspace_free(&fitter->lights);
    free(fitter->light);
    free(fitter->now.light_code);
    free(fitter->kept.light_code);
}

const weft_grey_fit *weft_texel_light_start(weft_texel_fitter *fitter, const weft_fit_options *options,
                                            const weft_grey_fit *start)
{
    weft_fit_options grey = *options;
    grey.fit_frame = fitter->source->frames == WEFT_FRAMES_FITTED && options->lobe_count > 0;
    fitter->lit.fit = start->fit;
    memcpy(fitter->lit.table, start->table, (size_t)fitter->bundle.view_count * sizeof *start->table);
    for (int l = 0; l < fitter->light_count; l++)
        fitter->grey_light[l] = 1;
    weft_light_refine(&fitter->bundle, &fitter->samples, WEFT_GREY, &grey, GREY_ROUNDS, fitter->workspace,
                      &fitter->lights, &fitter->lit.fit, fitter->lit.table, fitter->grey_light);
    return &fitter->lit;
}

void weft_texel_light_refine(weft_texel_fitter *fitter, const weft_fit_options *options, int channel, weft_fit *fit)
{
    const weft_bundle *bundle = &fitter->bundle;
    uint8_t *code = fitter->now.light_code + (size_t)channel * (size_t)fitter->light_count;
    weft_fit_options once = *options;
    double largest = 0;
    memcpy(fitter->light, fitter->grey_light, (size_t)fitter->light_count * sizeof *fitter->light);
    weft_light_refine(bundle, &fitter->samples, channel, options, CHANNEL_ROUNDS, fitter->workspace, &fitter->lights,
                      fit, fitter->table, fitter->light);
    for (int l = 0; l < fitter->light_count; l++)
        largest = fmax(largest, fitter->light[l]);
    for (int l = 0; l < fitter->light_count; l++)
        code[l] = weft_code_of_table(largest > 0 ? fitter->light[l] / largest : 1);
    weft_samples lit = weft_texel_samples_as_lit(fitter, channel);
    once.max_passes = 1;
    weft_fit_refine(bundle, &lit, channel, &once, fitter->workspace, fit, fitter->table);
}
