#include "compress/sparse/sparse.h"

#include "base/integers.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static weft_code allocate(int width, int height, int image_count, weft_sparse_field *field, weft_error *error)
{
    *field = (weft_sparse_field){.width = width, .height = height, .image_count = image_count};
    size_t samples = (size_t)width * (size_t)height * (size_t)image_count;
    field->light = calloc(3 * samples, sizeof(float));
    field->view = calloc(3 * samples, sizeof(float));
    field->value = calloc(3 * samples, sizeof(float));
    field->weight = calloc(samples, sizeof(float));
    field->image_weight = calloc((size_t)image_count, sizeof(float));
    if (field->light && field->view && field->value && field->weight && field->image_weight)
        return WEFT_OK;
    weft_sparse_field_free(field);
    return weft_fail_memory(error, "samples of all texels", 10 * samples * sizeof(float));
}

void weft_sparse_field_free(weft_sparse_field *field)
{
    free(field->light);
    free(field->view);
    free(field->value);
    free(field->weight);
    free(field->image_weight);
    *field = (weft_sparse_field){0};
}

static void store_direction(weft_vec3 direction, float *to)
{
    to[0] = (float)direction.x;
    to[1] = (float)direction.y;
    to[2] = (float)direction.z;
}

/* Sample `at` of the field from image `image` of texel (x, y); false where it cannot be used. */
static bool store_sample(const weft_dataset_layout *layout, int image, int x, int y, const weft_half *half,
                         uint8_t mask, const weft_sparse_field *field, size_t at)
{
    weft_vec3 light = weft_dataset_light_direction(layout, image, x, y);
    store_direction(light, field->light + 3 * at);
    store_direction(weft_dataset_view_direction(layout, layout->view_of_image[image], x, y), field->view + 3 * at);
    bool valid = mask == 0 && light.z > 0;
    for (int k = 0; k < 3; k++)
        valid = valid && isfinite(weft_float_of_half(half[k]));
    float factor = layout->values == WEFT_REFLECTANCE ? (float)light.z : 1;
    for (int k = 0; k < 3; k++)
        field->value[3 * at + (size_t)k] = valid ? factor * weft_float_of_half(half[k]) : 0;
    field->weight[at] = valid && field->image_weight[at % (size_t)field->image_count] > 0;
    return valid;
}

/* Weights of the images that are not held out: 1 in the mean, so that only ratios matter. */
static void weigh_images(const weft_dataset_layout *layout, const uint8_t *held_out, const weft_sparse_field *field)
{
    const double *weight = layout->figure[WEFT_IMAGE_WEIGHT];
    double sum = 0;
    for (int image = 0; weight && image < layout->image_count; image++)
        sum += held_out && held_out[image] ? 0 : weight[image];
    double scale = sum > 0 ? field->image_count / sum : 1;
    for (int image = 0, at = 0; image < layout->image_count; image++) {
        if (!(held_out && held_out[image]))
            field->image_weight[at++] = weight ? (float)(scale * weight[image]) : 1;
    }
}

static long store_row(const weft_dataset_layout *layout, const uint8_t *held_out, int y, const weft_half *half,
                      const uint8_t *mask, const weft_sparse_field *field)
{
    long masked = 0;
    size_t at = (size_t)y * (size_t)field->width * (size_t)field->image_count, from = 0;
    for (int x = 0; x < layout->width; x++) {
        for (int image = 0; image < layout->image_count; image++, from++) {
            if (held_out && held_out[image])
                continue;
            masked += !store_sample(layout, image, x, y, half + 3 * from, mask[from], field, at++);
        }
    }
    return masked;
}

weft_code weft_sparse_field_read(weft_dataset *dataset, const uint8_t *held_out, weft_sparse_field *field,
                                 long *masked_count, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    int images = 0;
    for (int image = 0; image < layout->image_count; image++)
        images += !(held_out && held_out[image]);
    WEFT_TRY(allocate(layout->width, layout->height, images, field, error));
    field->whole_width = layout->width;
    field->whole_height = layout->height;
    weigh_images(layout, held_out, field);
    size_t samples = (size_t)layout->width * (size_t)layout->image_count;
    weft_half *half = malloc(3 * samples * sizeof *half);
    uint8_t *mask = malloc(samples);
    weft_code code = half && mask ? WEFT_OK : weft_fail_memory(error, "row of the dataset", 7 * samples);
    *masked_count = 0;
    for (int y = 0; code == WEFT_OK && y < layout->height; y++) {
        code = weft_dataset_read_block(dataset, 0, y, layout->width, 1, half, mask, error);
        if (code == WEFT_OK)
            *masked_count += store_row(layout, held_out, y, half, mask, field);
    }
    free(half);
    free(mask);
    if (code != WEFT_OK)
        weft_sparse_field_free(field);
    return code;
}

static void unit_in_place(float *direction)
{
    weft_vec3 unit = weft_unit(weft_vec3_of((double)direction[0], (double)direction[1], (double)direction[2]));
    store_direction(unit, direction);
}

/* Texels of level 0 that texel (x, y) stands for. */
static float texels_in(const weft_sparse_field *field, int x, int y)
{
    int left = x << field->level, top = y << field->level, side = 1 << field->level;
    return (float)(weft_smaller(side, field->whole_width - left) * weft_smaller(side, field->whole_height - top));
}

/* Mean over the children of one sample; weights count, directions do not depend on them. */
static void halve_sample(const weft_sparse_field *field, int x, int y, int image, const weft_sparse_field *half,
                         size_t at)
{
    float texels = 0, weight = 0, sum[3] = {0};
    for (int row = 2 * y; row < 2 * y + 2 && row < field->height; row++) {
        for (int column = 2 * x; column < 2 * x + 2 && column < field->width; column++) {
            size_t texel = (size_t)row * (size_t)field->width + (size_t)column;
            size_t from = texel * (size_t)field->image_count + (size_t)image;
            float own = texels_in(field, column, row), valid = own * field->weight[from];
            for (size_t k = 0; k < 3; k++) {
                half->light[3 * at + k] += own * field->light[3 * from + k];
                half->view[3 * at + k] += own * field->view[3 * from + k];
                sum[k] += valid * field->value[3 * from + k];
            }
            weight += valid;
            texels += own;
        }
    }
    unit_in_place(half->light + 3 * at);
    unit_in_place(half->view + 3 * at);
    half->weight[at] = weight / texels;
    for (size_t k = 0; k < 3; k++)
        half->value[3 * at + k] = weight > 0 ? sum[k] / weight : 0;
}

weft_code weft_sparse_field_halve(const weft_sparse_field *field, weft_sparse_field *half, weft_error *error)
{
    WEFT_TRY(allocate((field->width + 1) / 2, (field->height + 1) / 2, field->image_count, half, error));
    half->level = field->level + 1;
    half->whole_width = field->whole_width;
    half->whole_height = field->whole_height;
    memcpy(half->image_weight, field->image_weight, (size_t)field->image_count * sizeof *half->image_weight);
    size_t at = 0;
    for (int y = 0; y < half->height; y++) {
        for (int x = 0; x < half->width; x++) {
            for (int image = 0; image < half->image_count; image++)
                halve_sample(field, x, y, image, half, at++);
        }
    }
    return WEFT_OK;
}
