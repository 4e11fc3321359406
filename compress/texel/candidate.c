#include "compress/texel/candidate.h"

#include <string.h>

double weft_candidate_bytes(const weft_candidate *candidate)
{
    weft_model_parts parts = candidate->parts;
    const weft_material *material = candidate->material;
    int bits = parts.table_bits * material->view_count + parts.light_table_bits * material->light_count;
    return 3 * (2 + 8 * parts.lobe_count + bits / 8.0);
}

static void copy_table(const uint8_t *from, int bits, int count, size_t texels, size_t texel, uint8_t *to)
{
    for (size_t i = 0; i < (size_t)count; i++) {
        for (size_t channel = 0; channel < 3; channel++) {
            size_t at = 4 * (i * texels + texel) + channel;
            to[at] = from ? weft_table_code_rounded(from[at], bits) : 255;
        }
    }
}

void weft_candidate_copy_texel(const weft_candidate *candidate, int level, size_t texel, weft_material *to)
{
    const weft_half neutral[4] = {0, 0, 0, weft_half_of_float(1)};
    const weft_material_level *source = &candidate->material->level[level];
    weft_material_level *target = &to->level[level];
    size_t texels = (size_t)target->width * (size_t)target->height;
    memcpy(target->frame + 3 * texel, source->frame + 3 * texel, 3 * sizeof *source->frame);
    memcpy(target->diffuse + 4 * texel, source->diffuse + 4 * texel, 4 * sizeof *source->diffuse);
    for (size_t i = 0; i < 3 * (size_t)to->lobe_count; i++) {
        size_t at = 4 * (i * texels + texel);
        bool has = i < 3 * (size_t)candidate->material->lobe_count;
        memcpy(target->lobe + at, has ? source->lobe + at : neutral, sizeof neutral);
    }
    copy_table(source->table, candidate->parts.table_bits, to->view_count, texels, texel, target->table);
    copy_table(source->light_table, candidate->parts.light_table_bits, to->light_count, texels, texel,
               target->light_table);
}
