#include "compress/components/images.h"

#include "compress/run/group_sums.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { WHOLE_LANES = 16 };

weft_code weft_component_images_allocate(int image_count, int view_count, weft_component_images *images,
                                         weft_error *error)
{
    size_t count = (size_t)image_count, views = (size_t)view_count;
    *images = (weft_component_images){0};
    images->image = malloc(count * sizeof *images->image);
    images->first = malloc((views + 1) * sizeof *images->first);
    images->light = malloc(count * sizeof *images->light);
    images->view = malloc(views * sizeof *images->view);
    images->height = malloc(count * sizeof *images->height);
    images->cosine = malloc(count * sizeof *images->cosine);
    images->weight = calloc(count, sizeof *images->weight);
    if (images->image && images->first && images->light && images->view && images->height && images->cosine &&
        images->weight) {
        images->first[0] = 0;
        return WEFT_OK;
    }
    weft_component_images_free(images);
    return weft_fail_memory(error, "images of components", count * sizeof *images->light);
}

weft_code weft_component_images_copy(const weft_component_images *images, weft_component_images *copy,
                                     weft_error *error)
{
    size_t count = (size_t)images->image_count, views = (size_t)images->view_count;
    WEFT_TRY(weft_component_images_allocate(images->image_count, images->view_count, copy, error));
    copy->image_count = images->image_count;
    copy->view_count = images->view_count;
    copy->length = images->length;
    copy->dataset_image_count = images->dataset_image_count;
    memcpy(copy->image, images->image, count * sizeof *copy->image);
    memcpy(copy->first, images->first, (views + 1) * sizeof *copy->first);
    memcpy(copy->light, images->light, count * sizeof *copy->light);
    memcpy(copy->view, images->view, views * sizeof *copy->view);
    memcpy(copy->height, images->height, count * sizeof *copy->height);
    memcpy(copy->cosine, images->cosine, count * sizeof *copy->cosine);
    memcpy(copy->weight, images->weight, count * sizeof *copy->weight);
    return WEFT_OK;
}

/* What follows from the direction of the light. */
static void light_from(const weft_dataset_layout *layout, weft_vec3 light, int i, weft_component_images *images)
{
    images->light[i] = light;
    images->height[i] = (float)light.z;
    images->cosine[i] = layout->values == WEFT_REFLECTANCE ? (float)light.z : 1.0f;
}

void weft_component_images_look_from(const weft_dataset_layout *layout, int x, int y, weft_component_images *images)
{
    for (int view = 0; view < images->view_count; view++) {
        int first = images->image[images->first[view]];
        images->view[view] = weft_dataset_view_direction(layout, layout->view_of_image[first], x, y);
    }
    for (int i = 0; i < images->image_count; i++)
        light_from(layout, weft_dataset_light_direction(layout, images->image[i], x, y), i, images);
}

void weft_component_images_free(weft_component_images *images)
{
    free(images->image);
    free(images->first);
    free(images->light);
    free(images->view);
    free(images->height);
    free(images->cosine);
    free(images->weight);
    *images = (weft_component_images){0};
}

/* Of the largest weight: an image that counts for less is left out, because the maps of the components go through all
 * others alike. */
static const double least_weight = 0.01;

/* What the dataset says that the samples of an image count for, as a share of the largest; 0: nothing. */
static double weight_of(const weft_dataset_layout *layout, int image)
{
    const double *weight = layout->figure[WEFT_IMAGE_WEIGHT];
    double largest = 0;
    for (int i = 0; weight && i < layout->image_count; i++)
        largest = fmax(largest, weight[i]);
    double share = weight && largest > 0 ? weight[image] / largest : 1;
    return share < least_weight ? 0 : share;
}

static void add_image(weft_component_images *images, const weft_dataset_layout *layout, int image)
{
    int i = images->image_count++;
    light_from(layout, weft_unit(layout->light[image]), i, images);
    images->image[i] = image;
    images->weight[i] = (float)sqrt(weight_of(layout, image));
}

static void add_view(weft_component_images *images, const weft_dataset_layout *layout, const uint8_t *held_out,
                     int view)
{
    int before = images->image_count;
    for (int image = 0; image < layout->image_count; image++) {
        if (layout->view_of_image[image] == view && layout->light[image].z > 0 && !(held_out && held_out[image]) &&
            weight_of(layout, image) > 0)
            add_image(images, layout, image);
    }
    if (images->image_count == before)
        return;
    images->view[images->view_count] = weft_unit(layout->view[view]);
    images->first[++images->view_count] = (uint32_t)images->image_count;
}

/* Their mean square is 1, so that only ratios matter. */
static void normalise_weights(weft_component_images *images)
{
    double sum = 0;
    for (int i = 0; i < images->image_count; i++)
        sum += (double)images->weight[i] * (double)images->weight[i];
    float scale = (float)sqrt(images->image_count / sum);
    for (int i = 0; i < images->image_count; i++)
        images->weight[i] *= scale;
}

weft_code weft_component_images_create(const weft_dataset_layout *layout, const uint8_t *held_out,
                                       weft_component_images *images, weft_error *error)
{
    weft_code code = weft_component_images_allocate(layout->image_count, layout->view_count, images, error);
    if (code == WEFT_OK) {
        images->dataset_image_count = layout->image_count;
        for (int view = 0; view < layout->view_count; view++) {
            if (layout->view[view].z > 0)
                add_view(images, layout, held_out, view);
        }
        images->length = (3 * (size_t)images->image_count + WHOLE_LANES - 1) / WHOLE_LANES * WHOLE_LANES;
        if (images->image_count > 0)
            normalise_weights(images);
        else
            code = weft_fail(error, WEFT_BAD_USAGE, "no image is left to fit components to");
    }
    if (code != WEFT_OK)
        weft_component_images_free(images);
    return code;
}

void weft_component_images_add(weft_component_images *images, const weft_component_images *from, int index, int image)
{
    int i = images->image_count++;
    images->image[i] = image;
    images->light[i] = from->light[index];
    images->height[i] = from->height[index];
    images->weight[i] = from->weight[index];
    images->cosine[i] = from->cosine[index];
}

/* A channel with this share of the brightest channel of a clipped sample may be clipped as well. */
static const float clipped_share = 0.87f;

/* What a masked sample tells, which goes to rgb. */
static uint8_t know_masked(const weft_half *sample, uint8_t mask, float rgb[3])
{
    unsigned known = 0;
    if (mask != WEFT_MASK_SATURATED)
        return 0;
    for (int c = 0; c < 3; c++)
        rgb[c] = weft_float_of_half(sample[c]);
    float brightest = fmaxf(fmaxf(rgb[0], rgb[1]), rgb[2]);
    bool is_bound = brightest > 0 && fminf(fminf(rgb[0], rgb[1]), rgb[2]) >= 0;
    for (int c = 0; c < 3 && is_bound; c++)
        known |= rgb[c] >= clipped_share * brightest ? (unsigned)WEFT_SAMPLE_CLIPPED << c : 0;
    return (uint8_t)known;
}

int weft_component_images_gather(const weft_component_images *images, const weft_half *samples, const uint8_t *mask,
                                 float *scratch, float *vector, uint8_t *known)
{
    size_t count = (size_t)images->image_count;
    const float *samples_counted = scratch + 3 * (size_t)images->dataset_image_count;
    int valid_count = 0;
    weft_group_of_texel(samples, mask, NULL, (size_t)images->dataset_image_count, scratch);
    memset(vector, 0, images->length * sizeof *vector);
    memset(known, 0, count);
    for (int view = 0; view < images->view_count; view++)
        for (size_t i = images->first[view]; i < images->first[view + 1]; i++) {
            size_t image = (size_t)images->image[i];
            float *rgb = scratch + 3 * image;
            if (!(images->height[i] > 0 && images->view[view].z > 0))
                continue;
            known[i] =
                samples_counted[image] > 0 ? WEFT_SAMPLE_VALID : know_masked(samples + 3 * image, mask[image], rgb);
            if (!known[i])
                continue;
            float factor = images->weight[i] * images->cosine[i];
            valid_count += known[i] == WEFT_SAMPLE_VALID;
            for (size_t c = 0; c < 3; c++)
                vector[3 * i + c] = factor * rgb[c];
        }
    return valid_count;
}
