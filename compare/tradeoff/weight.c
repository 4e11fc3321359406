#include "compare/tradeoff/weight.h"

weft_code weft_weight_of(const weft_material *material, weft_weight *weight, weft_error *error)
{
    uint64_t by_texels, shared;
    WEFT_TRY(weft_material_weigh(material, &by_texels, &shared, error));
    *weight = (weft_weight){.by_texels = (double)by_texels, .shared = (double)shared};
    for (int k = 0; k < material->level_count; k++)
        weight->texels += (double)material->level[k].width * material->level[k].height;
    return WEFT_OK;
}

double weft_weight_scaled(const weft_weight *weight, int width, int height, bool levels)
{
    double texels = (double)width * height;
    while (levels && (width > 1 || height > 1)) {
        width = (width + 1) / 2;
        height = (height + 1) / 2;
        texels += (double)width * height;
    }
    return weight->by_texels * texels / weight->texels + weight->shared;
}
