#include "compare/tradeoff/prediction.h"

#include "base/integers.h"
#include "compress/hold_out/certify.h"

#include <math.h>

/* Between 0.1 and 1, another one at each call: the additive sequence of the golden ratio. */
static double next_number(double *last)
{
    *last = fmod(*last + 0.61803398874989485, 1);
    return 0.1 + 0.9 * *last;
}

static weft_error_summary next_summary(double *last)
{
    return (weft_error_summary){.median_relative = next_number(last),
                                .percentile80_relative = next_number(last),
                                .rmse = next_number(last),
                                .relative_rmse = next_number(last),
                                .psnr_db = 30 * next_number(last),
                                .count = (long)(1e6 * next_number(last))};
}

static weft_hold_out_error next_errors(double *last, bool of_views, bool of_lights)
{
    weft_hold_out_error errors = {.all = next_summary(last)};
    if (of_views)
        errors.view = next_summary(last);
    if (of_lights)
        errors.light = next_summary(last);
    if (of_views && of_lights)
        errors.both = next_summary(last);
    return errors;
}

/* Squares of the subset are averaged while there are four: as many levels as the dataset has from so many texels on.
 */
static int expected_levels(const weft_dataset_layout *layout)
{
    int levels = (int)log2((double)weft_smaller(layout->width, layout->height));
    return weft_larger(1, weft_smaller(levels, WEFT_MATERIAL_MAX_LEVELS));
}

static weft_certificate expected_certificate(const weft_dataset_layout *layout, double *last)
{
    weft_certificate c = {.probability = 0.95,
                          .over_images = true,
                          .image_count = 1232,
                          .direction_count = 16,
                          .mean = (double)(float)(0.1 * next_number(last)),
                          .level_count = expected_levels(layout),
                          .measured_levels = 1};
    for (int knot = 0; knot < WEFT_CERTIFICATE_KNOTS; knot++) {
        c.value[knot] = 0.5 * knot + 0.4 * next_number(last);
        c.spread[knot] = next_number(last);
    }
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        c.view[ring] = 0.5 + next_number(last);
        c.light[ring] = 0.5 + next_number(last);
        c.view_images[ring] = c.light_images[ring] = (int)(500 * next_number(last));
    }
    for (int k = 0; k < c.level_count; k++) {
        c.level[k].quantile = 0.5 + next_number(last);
        for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
            c.level[k].fitted[ring] = next_number(last);
            c.level[k].storage[ring] = 0.09 * next_number(last);
        }
    }
    weft_certificate_round(&c);
    return c;
}

static weft_hold_out record_of(const weft_dataset_layout *layout, const weft_splits *splits, int split_count,
                               bool has_surface, const weft_compress_options *options)
{
    double last = 0;
    bool views = splits->view_held_count > 0, lights = splits->light_held_count > 0;
    weft_hold_out record = {.kind = splits->kind,
                            .split_count = splits->kind == WEFT_SPLIT_EACH ? splits->count : split_count,
                            .view_count = splits->view_count,
                            .view_held_count = splits->view_held_count,
                            .light_count = splits->light_count,
                            .light_held_count = splits->light_held_count,
                            .image_count = splits->image_count,
                            .image_held_count = (splits->image_count + 9) / 10,
                            .texel_count = 144,
                            .dataset_texel_count = (long)layout->width * layout->height,
                            .material = next_errors(&last, views, lights),
                            .photographs = next_errors(&last, views, lights),
                            .fitted = next_summary(&last),
                            .has_certificate = true,
                            .certificate = expected_certificate(layout, &last)};
    if (has_surface)
        record.photographs_flat = next_number(&last);
    if (has_surface && options->component_count > 0)
        record.heights = (weft_hold_out_heights){true, options->heights, next_number(&last), next_number(&last)};
    return record;
}

weft_code weft_expected_record(weft_dataset *dataset, const weft_compress_options *options, weft_hold_out *expected,
                               weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    weft_splits splits;
    int split_count;
    WEFT_TRY(weft_hold_out_enough_splits(layout, &split_count, error));
    WEFT_TRY(weft_splits_create(layout, 0, 2, &splits, error));
    *expected = record_of(layout, &splits, split_count, weft_dataset_has_surface(dataset), options);
    weft_splits_free(&splits);
    return weft_certify_registration(dataset, &expected->certificate, error);
}
