/* T of the views that do not see a texel: of the texels beside a frame, say, those that look across it. */
#include "compress/texel/parts.h"

#include <math.h>
#include <string.h>

/* How much brighter, as a root mean square, a view without samples may be than the nearest one with: facing the rim of
 * the hemisphere, cloth is brighter indeed. */
#define MOST_BRIGHTER 1.5

/* Valid samples by view; returns whether some view has none. */
static bool count_samples(weft_texel_fitter *fitter)
{
    const weft_bundle *bundle = &fitter->bundle;
    memset(fitter->seen, 0, (size_t)bundle->view_count * sizeof *fitter->seen);
    for (int i = 0; i < bundle->sample_count; i++)
        fitter->seen[bundle->view_of[i]] += fitter->samples.cosine[i] > 0;
    for (int view = 0; view < bundle->view_count; view++) {
        if (fitter->seen[view] == 0)
            return true;
    }
    return false;
}

static int nearest_seen(const weft_texel_fitter *fitter, int view)
{
    const weft_bundle *bundle = &fitter->bundle;
    int nearest = -1;
    for (int other = 0; other < bundle->view_count; other++) {
        if (fitter->seen[other] > 0 && (nearest < 0 || weft_dot(bundle->view[view], bundle->view[other]) >
                                                           weft_dot(bundle->view[view], bundle->view[nearest])))
            nearest = other;
    }
    return nearest;
}

/* Mean square of the model without T over all lights of a view, masked or not. */
static void measure_views(weft_texel_fitter *fitter, int channel)
{
    const weft_bundle *bundle = &fitter->bundle;
    weft_samples all = fitter->samples;
    all.cosine = bundle->light[2];
    const float *model = weft_fit_evaluate(bundle, &all, fitter->workspace, &fitter->as_read[channel]);
    double *energy = fitter->table, *count = energy + bundle->view_count;
    memset(energy, 0, 2 * (size_t)bundle->view_count * sizeof *energy);
    for (int i = 0; i < bundle->sample_count; i++) {
        if (bundle->image[i] < 0 || !(all.cosine[i] > 0))
            continue;
        energy[bundle->view_of[i]] += (double)model[i] * (double)model[i];
        count[bundle->view_of[i]]++;
    }
    for (int view = 0; view < bundle->view_count; view++)
        energy[view] /= fmax(count[view], 1);
}

void weft_texel_limit_unseen(weft_texel_fitter *fitter, int channel)
{
    const weft_bundle *bundle = &fitter->bundle;
    uint8_t *code = fitter->code + (size_t)channel * (size_t)bundle->view_count;
    if (fitter->samples.valid_count == bundle->image_count || !count_samples(fitter))
        return;
    measure_views(fitter, channel);
    for (int view = 0; view < bundle->view_count; view++) {
        int nearest = fitter->seen[view] == 0 ? nearest_seen(fitter, view) : -1;
        if (nearest < 0)
            continue;
        double own = fitter->table[view], other = fitter->table[nearest];
        double most = own > 0 ? MOST_BRIGHTER * weft_table_of_code(code[nearest]) * sqrt(other / own) : 1;
        code[view] = weft_code_of_table(fmin(weft_table_of_code(code[view]), most));
    }
}
