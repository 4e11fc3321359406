#include "compress/options/options.h"

#include "btf/material/material.h"

weft_compress_options weft_compress_default_options(void)
{
    return (weft_compress_options){.component_count = WEFT_COMPONENTS_AUTOMATIC,
                                   .lobe_count = 2,
                                   .weights = WEFT_WEIGHTS_BY_MODEL,
                                   .levels = true,
                                   .heights = true};
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
    int most = options->finer ? WEFT_COMPONENTS_MAX / 2 : WEFT_COMPONENTS_MAX;
    if (options->component_count < 0 || options->component_count > most ||
        options->component_count % WEFT_COMPONENTS_GROUP != 0)
        return weft_fail(error, WEFT_BAD_USAGE, "%d components: must be 4 to %d, a multiple of 4",
                         options->component_count, most);
    if (options->component_count == 0 && (options->lobe_count < 0 || options->lobe_count > WEFT_MATERIAL_MAX_LOBES))
        return weft_fail(error, WEFT_BAD_USAGE, "%d lobes asked for, must be 0 to %d", options->lobe_count,
                         WEFT_MATERIAL_MAX_LOBES);
    if (weft_compress_options_count_images(options, weft_dataset_get_layout(dataset)) == 0)
        return weft_fail(error, WEFT_BAD_USAGE, "'%s': every image is held out", weft_dataset_path(dataset));
    return WEFT_OK;
}
