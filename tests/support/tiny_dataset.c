#include "tests/support/tiny_dataset.h"

#include "btf/direction/direction.h"

#include <stdlib.h>

weft_dataset_layout tiny_layout(int width, int height, int views, int lights)
{
    weft_dataset_layout layout = {.width = width,
                                  .height = height,
                                  .image_count = views * lights,
                                  .view_count = views,
                                  .values = WEFT_REFLECTANCE_COSINE,
                                  .distance = WEFT_FAR,
                                  .texel_pitch_mm = 0.25};
    if (weft_dataset_layout_allocate(&layout, NULL) != WEFT_OK)
        abort();
    for (int image = 0; image < layout.image_count; image++) {
        int view = image / lights;
        layout.light[image] = weft_direction_of_angles(weft_ubo81_angles(image % lights));
        layout.view[view] = weft_direction_of_angles(weft_ubo81_angles(view));
        layout.view_of_image[image] = view;
    }
    return layout;
}

uint8_t tiny_smooth(const weft_dataset_layout *layout, int image, int x, int y, float rgb[3])
{
    weft_vec3 light = weft_dataset_light_direction(layout, image, x, y);
    weft_vec3 view = weft_dataset_view_direction(layout, layout->view_of_image[image], x, y);
    weft_vec3 half_vector = weft_unit(weft_add(light, view));
    double gloss = 0.5 * pow(weft_clamp(half_vector.z, 0, 1), 20);
    for (int channel = 0; channel < 3; channel++) {
        double albedo = 0.2 + 0.1 * channel + 0.3 * (x + 0.5) / layout->width + 0.1 * (y + 0.5) / layout->height;
        rgb[channel] = (float)((albedo + gloss) * light.z);
    }
    return 0;
}

uint8_t tiny_distinct(const weft_dataset_layout *layout, int image, int x, int y, float rgb[3])
{
    int number = (y * layout->width + x) * layout->image_count + image;
    for (int channel = 0; channel < 3; channel++)
        rgb[channel] = (float)(1 + (3 * number + channel) % 2039) / 16;
    return number % 7 != 6 ? 0 : number % 2 ? WEFT_MASK_DARK : WEFT_MASK_SATURATED;
}

void tiny_image(const weft_dataset_layout *layout, tiny_sample *sample, int image, weft_half *samples, uint8_t *mask)
{
    for (int y = 0; y < layout->height; y++) {
        for (int x = 0; x < layout->width; x++) {
            float rgb[3];
            *mask++ = sample(layout, image, x, y, rgb);
            for (int channel = 0; channel < 3; channel++)
                *samples++ = weft_half_of_float(rgb[channel]);
        }
    }
}

static weft_code put_images(weft_dataset_writer *writer, const weft_dataset_layout *layout, tiny_sample *sample,
                            weft_error *error)
{
    size_t texels = (size_t)layout->width * (size_t)layout->height;
    weft_half *samples = malloc(texels * 3 * sizeof *samples);
    uint8_t *mask = malloc(texels);
    if (!samples || !mask)
        abort();
    weft_code code = WEFT_OK;
    for (int image = 0; image < layout->image_count && code == WEFT_OK; image++) {
        tiny_image(layout, sample, image, samples, mask);
        code = weft_dataset_writer_put_image(writer, image, samples, mask, error);
    }
    free(samples);
    free(mask);
    return code;
}

weft_code tiny_dataset_write(const char *path, const weft_dataset_layout *layout, tiny_sample *sample,
                             weft_error *error)
{
    weft_dataset_writer *writer;
    WEFT_TRY(weft_dataset_writer_create(path, layout, &writer, error));
    weft_code code = put_images(writer, layout, sample, error);
    if (code == WEFT_OK)
        return weft_dataset_writer_finish(writer, NULL, error);
    weft_dataset_writer_abandon(writer);
    return code;
}
