#include "edit/tile/search_steps.h"

#include "btf/dataset/read_blocks.h"
#include "btf/direction/direction.h"

#include <stdbool.h>
#include <stdlib.h>

/* Floats of the pictures in memory, at most. */
static const size_t enough_values = (size_t)1 << 26;

static float grey_of(const weft_half *rgb)
{
    return (weft_float_of_half(rgb[0]) + weft_float_of_half(rgb[1]) + weft_float_of_half(rgb[2])) / 3;
}

/* ---- Choosing ---- */

/* Over the valid texels of an image, and over pairs of neighbours both valid. */
typedef struct texture_sums {
    double sum, products;
    long count, pairs;
} texture_sums;

typedef struct choosing {
    int image_count;
    texture_sums *image; /* [image_count] */
} choosing;

static void add_pair(texture_sums *sums, const weft_walk_block *block, size_t at, size_t neighbour)
{
    if (block->mask[neighbour])
        return;
    sums->products += (double)grey_of(block->samples + 3 * at) * (double)grey_of(block->samples + 3 * neighbour);
    sums->pairs++;
}

static void add_image(texture_sums *sums, const weft_walk_block *block, size_t image, size_t images)
{
    for (int y = 0; y < block->height; y++) {
        for (int x = 0; x < block->width; x++) {
            size_t at = ((size_t)y * (size_t)block->width + (size_t)x) * images + image;
            if (block->mask[at])
                continue;
            sums->sum += (double)grey_of(block->samples + 3 * at);
            sums->count++;
            if (x + 1 < block->width)
                add_pair(sums, block, at, at + images);
            if (y + 1 < block->height)
                add_pair(sums, block, at, at + images * (size_t)block->width);
        }
    }
}

static void add_textures(void *context, const weft_walk_block *block)
{
    const choosing *choice = context;
#pragma omp parallel for schedule(static)
    for (int i = 0; i < choice->image_count; i++)
        add_image(&choice->image[i], block, (size_t)i, (size_t)choice->image_count);
}

/* From the normal, of light and view of an image that is used. */
static const double steepest_deg = 65;

/* Covariance of neighbours relative to the squared mean; negative for an image that is not to be used. */
static double texture_of(const weft_dataset_layout *layout, const texture_sums *sums, int image)
{
    const double least_cosine = cos(weft_rad_of_deg(steepest_deg));
    double texels = (double)layout->width * layout->height,
           mean = sums->sum / (double)(sums->count > 0 ? sums->count : 1);
    bool is_steep =
        layout->light[image].z < least_cosine || layout->view[layout->view_of_image[image]].z < least_cosine;
    if (is_steep || (double)sums->count < texels / 2 || sums->pairs == 0 || !(mean > 0))
        return -1;
    return sums->products / (double)sums->pairs / (mean * mean) - 1;
}

static void choose(const weft_dataset_layout *layout, const choosing *choice, int most, weft_tile_pictures *pictures)
{
    double score[WEFT_TILE_PICTURES] = {0};
    for (int i = 0; i < layout->image_count; i++) {
        double texture = texture_of(layout, &choice->image[i], i);
        int place = pictures->count;
        while (place > 0 && score[place - 1] < texture)
            place--;
        if (!(texture > 0) || place >= most)
            continue;
        pictures->count += pictures->count < most;
        for (int k = pictures->count - 1; k > place; k--) {
            score[k] = score[k - 1];
            pictures->image[k] = pictures->image[k - 1];
        }
        score[place] = texture;
        pictures->image[place] = i;
    }
}

static weft_code choose_images(weft_dataset *dataset, const weft_progress *progress, weft_tile_pictures *pictures,
                               weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    choosing choice = {.image_count = layout->image_count};
    choice.image = calloc((size_t)layout->image_count, sizeof *choice.image);
    if (!choice.image)
        return weft_fail_memory(error, "sums of images", (size_t)layout->image_count * sizeof *choice.image);
    size_t fit = enough_values / ((size_t)layout->width * (size_t)layout->height);
    int most = fit < 1 ? 1 : fit < WEFT_TILE_PICTURES ? (int)fit : WEFT_TILE_PICTURES;
    weft_code code = weft_walk_blocks(dataset, add_textures, &choice, "choosing images", progress, error);
    if (code == WEFT_OK)
        choose(layout, &choice, most, pictures);
    free(choice.image);
    if (code == WEFT_OK && pictures->count == 0)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has no texture in any image less than %g degrees steep",
                         weft_dataset_path(dataset), steepest_deg);
    return code;
}

/* ---- Reading ---- */

typedef struct copying {
    weft_tile_pictures *pictures;
    size_t image_count;
} copying;

static void copy_texels(void *context, const weft_walk_block *block)
{
    const copying *copy = context;
    weft_tile_pictures *pictures = copy->pictures;
    for (int y = 0; y < block->height; y++) {
        for (int x = 0; x < block->width; x++) {
            size_t from = ((size_t)y * (size_t)block->width + (size_t)x) * copy->image_count;
            for (int k = 0; k < pictures->count; k++) {
                size_t row = (size_t)k * (size_t)pictures->height + (size_t)(block->y + y);
                size_t to = row * (size_t)pictures->width + (size_t)(block->x + x);
                size_t sample = from + (size_t)pictures->image[k];
                pictures->mask[to] = block->mask[sample];
                pictures->value[to] = block->mask[sample] ? 0 : grey_of(block->samples + 3 * sample);
            }
        }
    }
}

/* Relative to the mean of the valid texels, less 1. No slope is taken away: that of a few tiles is not 0. */
static void level(float *value, const uint8_t *mask, size_t texels)
{
    double sum = 0, count = 0;
    for (size_t i = 0; i < texels; i++) {
        sum += (double)value[i];
        count += !mask[i];
    }
    for (size_t i = 0; i < texels; i++)
        value[i] = mask[i] ? 0 : (float)((double)value[i] * count / sum - 1);
}

/* Masked texels take the mean of their valid neighbours, so that a missing row does not look like a step. */
static void fill_masked(weft_tile_pictures *pictures, int k)
{
    int width = pictures->width, height = pictures->height;
    float *value = pictures->value + (size_t)k * (size_t)width * (size_t)height;
    const uint8_t *mask = pictures->mask + (size_t)k * (size_t)width * (size_t)height;
    for (int i = 0; i < width * height; i++) {
        int x = i % width, y = i / width, count = 0;
        float sum = 0;
        for (int side = 0; mask[i] && side < 4; side++) {
            int nx = x + (side == 0) - (side == 1), ny = y + (side == 2) - (side == 3), n = ny * width + nx;
            if (nx < 0 || ny < 0 || nx >= width || ny >= height || mask[n])
                continue;
            sum += value[n];
            count++;
        }
        if (count > 0)
            value[i] = sum / (float)count;
    }
}

weft_code weft_tile_pictures_read(weft_dataset *dataset, const weft_progress *progress, weft_tile_pictures *pictures,
                                  weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    *pictures = (weft_tile_pictures){.width = layout->width, .height = layout->height};
    WEFT_TRY(choose_images(dataset, progress, pictures, error));
    size_t texels = (size_t)layout->width * (size_t)layout->height, all = texels * (size_t)pictures->count;
    pictures->value = malloc(all * sizeof *pictures->value);
    pictures->mask = malloc(all);
    copying copy = {pictures, (size_t)layout->image_count};
    weft_code code = WEFT_OK;
    if (!pictures->value || !pictures->mask)
        code = weft_fail_memory(error, "images", 5 * all);
    if (code == WEFT_OK)
        code = weft_walk_blocks(dataset, copy_texels, &copy, "reading images", progress, error);
    for (int k = 0; code == WEFT_OK && k < pictures->count; k++) {
        level(pictures->value + (size_t)k * texels, pictures->mask + (size_t)k * texels, texels);
        fill_masked(pictures, k);
    }
    if (code != WEFT_OK)
        weft_tile_pictures_free(pictures);
    return code;
}

void weft_tile_pictures_free(weft_tile_pictures *pictures)
{
    free(pictures->value);
    free(pictures->mask);
    *pictures = (weft_tile_pictures){0};
}
