/* Models of a texel that are given, not sought. */
#include "compress/texel/parts.h"

#include <math.h>
#include <string.h>

static void load_channel(weft_texel_fitter *fitter, const weft_candidate *from, const weft_material_level *level,
                         size_t texel, int channel, const weft_frame *frame)
{
    const weft_material *material = from->material;
    size_t texels = (size_t)level->width * (size_t)level->height, c = (size_t)channel;
    size_t views = (size_t)fitter->bundle.view_count, lights = (size_t)fitter->light_count;
    weft_packed *packed = &fitter->now.packed[channel];
    packed->diffuse = level->diffuse[4 * texel + c];
    for (size_t i = 0; i < (size_t)material->lobe_count; i++)
        memcpy(packed->lobe[i], level->lobe + 4 * ((3 * i + c) * texels + texel), sizeof packed->lobe[i]);
    fitter->now.as_read[channel] = weft_unpack(packed, material->lobe_count, frame, fitter->samples.scale);
    for (size_t view = 0; view < views; view++)
        fitter->now.code[c * views + view] =
            level->table
                ? weft_table_code_rounded(level->table[4 * (view * texels + texel) + c], from->parts.table_bits)
                : 255;
    for (size_t l = 0; l < lights; l++)
        fitter->now.light_code[c * lights + l] =
            level->light_table ? weft_table_code_rounded(level->light_table[4 * (l * texels + texel) + c],
                                                         from->parts.light_table_bits)
                               : 255;
}

/* Whether the tables of a candidate have fewer bits than it was fitted with. A code that is rounded up makes its view
 * or its light brighter. */
static bool is_rounded(const weft_candidate *candidate)
{
    return candidate->parts.table_bits % 8 || candidate->parts.light_table_bits % 8;
}

weft_error_sums weft_texel_judge(weft_texel_fitter *fitter, int level, int x, int y)
{
    const weft_judgement *judgement = fitter->source->judgement;
    weft_error_sums sums = {0};
    for (int i = 0; i < judgement->count; i++) {
        const weft_candidate *candidate = &judgement->candidate[i];
        const weft_material_level *at = &candidate->material->level[level];
        size_t texel = (size_t)y * (size_t)at->width + (size_t)x;
        weft_frame frame = weft_frame_decode(at->frame + 3 * texel);
        for (int channel = 0; channel < WEFT_CHANNELS; channel++)
            load_channel(fitter, candidate, at, texel, channel, &frame);
        sums = weft_texel_measure(fitter, judgement->count == 1 && weft_texel_is_tallied(at, x, y));
        float *square_error = judgement->square_error[level];
        bool is_refused = square_error && is_rounded(candidate) && weft_texel_is_too_bright(fitter);
        if (square_error)
            square_error[texel * (size_t)judgement->count + (size_t)i] =
                is_refused ? INFINITY : (float)sums.square_error;
    }
    return sums;
}
