#include "compress/bard/texels.h"

#include "compress/bard/texel_table.h"

#include <math.h>
#include <stdlib.h>

int weft_bard_count_photographs(const weft_dataset_layout *layout, const uint8_t *left_out)
{
    weft_bard_plan plan;
    if (weft_bard_plan_create(layout, left_out, "", WEFT_BARD_IN_PLANE, &plan, NULL) != WEFT_OK)
        return 0;
    int count = plan.count;
    weft_bard_plan_free(&plan);
    return count;
}

static void predict_unknown(size_t values, weft_half *predicted)
{
    for (size_t i = 0; i < values; i++)
        predicted[i] = weft_half_of_float(NAN);
}

static weft_code predict_texels(const weft_bard_plan *plan, const weft_dataset_layout *layout, double diffuse_share,
                                const weft_half *samples, const uint8_t *mask, long texel_count, weft_half *predicted,
                                weft_error *error)
{
    size_t images = (size_t)layout->image_count;
    weft_bard_texel texel = {0};
    uint8_t *ignored = malloc(images);
    weft_code code = ignored ? weft_bard_texel_create(plan, &texel, error) : weft_fail_memory(error, "images", images);
    for (size_t at = 0; at < (size_t)texel_count && code == WEFT_OK; at++) {
        weft_bard_texel_measure(plan, layout, diffuse_share, samples + 3 * at * images, mask + at * images, &texel);
        weft_bard_texel_predict(plan, layout, &texel, predicted + 3 * at * images, ignored);
        if (texel.filled_count < 0)
            predict_unknown(3 * images, predicted + 3 * at * images);
    }
    weft_bard_texel_free(&texel);
    free(ignored);
    return code;
}

weft_code weft_bard_predict_texels(const weft_dataset_layout *layout, const uint8_t *left_out,
                                   const weft_bard_options *options, const weft_half *samples, const uint8_t *mask,
                                   long texel_count, weft_half *predicted, weft_error *error)
{
    weft_bard_plan plan;
    WEFT_TRY(weft_bard_plan_create(layout, left_out, "the dataset", options->map, &plan, error));
    weft_code code =
        predict_texels(&plan, layout, options->diffuse_share, samples, mask, texel_count, predicted, error);
    weft_bard_plan_free(&plan);
    return code;
}
