#include "compare/error_budget/error_budget.h"

#include "geometry/light/sample_sequence.h"

/* Keeps the place in the texel apart from the bounces of the path, which count from 0. */
#define PLACE_KEY 0x10000u

weft_rgb weft_cloth_reflectance(const weft_virtual_sample *sample, const weft_cloth_texel *texel, weft_vec3 light,
                                weft_vec3 view, int paths, uint64_t key)
{
    double side = sample->opening_mm;
    weft_rgb sum = {0, 0, 0};
    for (uint32_t i = 0; i < (uint32_t)paths; i++) {
        double point[2];
        weft_sequence_point(weft_sequence_key(key, PLACE_KEY), i, point);
        double x_mm = ((texel->x + point[0]) / texel->width - 0.5) * side;
        double y_mm = (0.5 - (texel->y + point[1]) / texel->height) * side;
        weft_rgb value = weft_virtual_sample_reflect(sample, x_mm, y_mm, light, view, key, i);
        sum = (weft_rgb){sum.r + value.r, sum.g + value.g, sum.b + value.b};
    }
    return (weft_rgb){sum.r / paths, sum.g / paths, sum.b / paths};
}
