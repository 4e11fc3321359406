#include "compare/tradeoff/held_error.h"

#include "base/numeric/statistics.h"

#include <math.h>
#include <stdlib.h>

static const double highlight_share = 0.95, shadow_share = 0.2, grazing_cosine = 0.6088; /* of 52.5 degrees */

const char *weft_sample_kind_name(weft_sample_kind kind)
{
    static const char *const name[] = {"all", "grazing", "highlights", "shadows"};
    return name[kind];
}

static float brightness(const weft_texel_subset *subset, int x, int y, size_t texel, int image)
{
    const weft_dataset_layout *layout = &subset->layout;
    size_t at = texel * (size_t)layout->image_count + (size_t)image;
    double sum = 0, cosine = (double)weft_dataset_light_direction(layout, image, x, y).z;
    for (size_t c = 0; c < 3; c++)
        sum += (double)weft_float_of_half(subset->samples[3 * at + c]);
    if (layout->values == WEFT_REFLECTANCE_COSINE)
        sum /= fmax(cosine, 1e-3);
    return subset->mask[at] || !(cosine > 0) ? NAN : (float)(sum / 3);
}

static bool is_grazing(const weft_dataset_layout *layout, int image, int x, int y)
{
    weft_vec3 light = weft_dataset_light_direction(layout, image, x, y);
    weft_vec3 view = weft_dataset_view_direction(layout, layout->view_of_image[image], x, y);
    return light.z < grazing_cosine || view.z < grazing_cosine;
}

/* `value` and `sorted` are [image_count]. */
static void mark_texel(const weft_texel_subset *subset, int x, int y, float *value, float *sorted, uint8_t *all_kinds)
{
    const weft_dataset_layout *layout = &subset->layout;
    size_t texel = (size_t)y * (size_t)layout->width + (size_t)x, images = (size_t)layout->image_count, count = 0;
    uint8_t *kinds = all_kinds + texel * images;
    for (int i = 0; i < layout->image_count; i++) {
        value[i] = brightness(subset, x, y, texel, i);
        if (!isnan(value[i]))
            sorted[count++] = value[i];
    }
    float bright = weft_quantile_of_floats(sorted, count, highlight_share),
          dark = weft_quantile_of_floats(sorted, count, shadow_share);
    for (int i = 0; i < layout->image_count; i++)
        kinds[i] =
            (uint8_t)(1 << WEFT_SAMPLES_ALL | is_grazing(layout, i, x, y) << WEFT_SAMPLES_GRAZING |
                      (value[i] >= bright) << WEFT_SAMPLES_HIGHLIGHTS | (value[i] <= dark) << WEFT_SAMPLES_SHADOWS);
}

weft_code weft_sample_kinds_mark(const weft_texel_subset *subset, uint8_t **kinds, weft_error *error)
{
    const weft_dataset_layout *layout = &subset->layout;
    size_t images = (size_t)layout->image_count, texels = (size_t)layout->width * (size_t)layout->height;
    float *value = malloc(2 * images * sizeof *value);
    *kinds = malloc(texels * images);
    if (!value || !*kinds) {
        free(value);
        return weft_fail_memory(error, "samples", texels * images);
    }
    for (int texel = 0; texel < (int)texels; texel++)
        mark_texel(subset, texel % layout->width, texel / layout->width, value, value + images, *kinds);
    free(value);
    return WEFT_OK;
}
