#include "synthetic_dataset.h"

#include "tests/support/cmocka_all.h"

#include <stdlib.h>

/* Samples [texel][image][3] of the whole dataset, as halves. */
static weft_half *fill_all(const weft_dataset_layout *layout, synthetic_fill *fill, uint8_t *mask)
{
    size_t images = (size_t)layout->image_count, texels = (size_t)layout->width * (size_t)layout->height;
    weft_half *half = calloc(3 * images * texels, sizeof *half);
    float *samples = calloc(3 * images, sizeof *samples);
    assert_true(half && samples);
    for (size_t texel = 0; texel < texels; texel++) {
        fill(layout, (int)(texel % (size_t)layout->width), (int)(texel / (size_t)layout->width), samples,
             mask + texel * images);
        for (size_t i = 0; i < 3 * images; i++)
            half[3 * texel * images + i] = weft_half_of_float(samples[i]);
    }
    free(samples);
    return half;
}

void synthetic_dataset_write(const char *path, const weft_dataset_layout *layout, synthetic_fill *fill)
{
    size_t images = (size_t)layout->image_count, texels = (size_t)layout->width * (size_t)layout->height;
    weft_error error = {0};
    weft_dataset_writer *writer = NULL;
    uint8_t *mask = calloc(texels * images, 1), *image_mask = calloc(texels, 1);
    weft_half *image_half = calloc(3 * texels, sizeof *image_half);
    assert_true(mask && image_mask && image_half);
    weft_half *half = fill_all(layout, fill, mask);
    assert_int_equal(weft_dataset_writer_create(path, layout, &writer, &error), WEFT_OK);
    for (size_t image = 0; image < images; image++) {
        for (size_t texel = 0; texel < texels; texel++) {
            image_mask[texel] = mask[texel * images + image];
            for (size_t k = 0; k < 3; k++)
                image_half[3 * texel + k] = half[3 * (texel * images + image) + k];
        }
        assert_int_equal(weft_dataset_writer_put_image(writer, (int)image, image_half, image_mask, &error), WEFT_OK);
    }
    assert_int_equal(weft_dataset_writer_finish(writer, NULL, &error), WEFT_OK);
    free(half);
    free(image_half);
    free(image_mask);
    free(mask);
}

weft_dataset *synthetic_dataset_open(const char *path)
{
    weft_dataset *dataset = NULL;
    weft_error error = {0};
    if (weft_dataset_open(path, &dataset, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    return dataset;
}
