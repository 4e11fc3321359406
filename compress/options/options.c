#include "compress/options/options.h"

#include "btf/material/material.h"

weft_compress_options weft_compress_default_options(void)
{
    return (weft_compress_options){.lobe_count = 2,
                                   .component_count = WEFT_COMPONENTS_AUTOMATIC,
                                   .table = true,
                                   .levels = true,
                                   .heights = true,
                                   .frames = WEFT_FRAMES_FITTED,
                                   .max_exponent = 8192};
}

int weft_compress_options_count_images(const weft_compress_options *options, const weft_dataset_layout *layout)
{
    int count = 0;
    for (int image = 0; image < layout->image_count; image++)
        count += !(options->held_out && options->held_out[image]);
    return count;
}

weft_code weft_compress_options_check(const weft_compress_options *options, const weft_dataset *dataset,
                                      weft_error *error)
{
    if (options->lobe_count < 0 || options->lobe_count > WEFT_MATERIAL_MAX_LOBES)
        return weft_fail(error, WEFT_BAD_USAGE, "%d lobes asked for, must be 0 to %d", options->lobe_count,
                         WEFT_MATERIAL_MAX_LOBES);
    if (!(options->max_exponent >= 1 && options->max_exponent <= 60000))
        return weft_fail(error, WEFT_BAD_USAGE, "largest exponent is %g, must be 1 to 60000", options->max_exponent);
    if (!(options->target_error >= 0 && options->target_error <= 1))
        return weft_fail(error, WEFT_BAD_USAGE, "target error is %g, must be 0 to 1", options->target_error);
    if (options->target_error > 0 && options->budget_bytes > 0)
        return weft_fail(error, WEFT_BAD_USAGE, "a target error and a budget exclude each other");
    if (options->rounded && options->component_count == 0)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "only components are rounded, and there are none: leave out --rounding");
    if (weft_compress_options_count_images(options, weft_dataset_get_layout(dataset)) == 0)
        return weft_fail(error, WEFT_BAD_USAGE, "'%s': every image is held out", weft_dataset_path(dataset));
    return WEFT_OK;
}
