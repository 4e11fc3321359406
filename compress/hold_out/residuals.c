#include "compress/hold_out/certify.h"

#include "base/integers.h"
#include "btf/direction/direction.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void weft_residuals_free(weft_residuals *residuals)
{
    for (int k = 0; k < WEFT_RESIDUAL_LEVELS; k++)
        free(residuals->value[k]);
    *residuals = (weft_residuals){0};
}

/* ---- Samples in order ---- */

/* What is said of every texel of a level in every image, NaN where nothing is: sample, prediction and moved prediction,
 * each [height][width][images][3]. */
typedef struct answers {
    int width, height, level;
    float *value[3];
} answers;

/* The images that are asked for, and of all images of the subset which place each has among them, or -1. */
typedef struct asked_images {
    int count;
    int *image, *place;
    uint8_t *flags;
} asked_images;

static void free_answers(answers *a)
{
    for (int i = 0; i < 3; i++)
        free(a->value[i]);
}

static void free_images(asked_images *images)
{
    free(images->image);
    free(images->place);
    free(images->flags);
}

static weft_code find_images(const weft_texel_subset *subset, const weft_asked_samples *asked, asked_images *images,
                             weft_error *error)
{
    size_t all = (size_t)subset->layout.image_count;
    *images = (asked_images){.image = calloc(all, sizeof *images->image),
                             .place = calloc(all, sizeof *images->place),
                             .flags = calloc(all, 1)};
    if (!images->image || !images->place || !images->flags)
        return weft_fail_memory(error, "images", all * (2 * sizeof(int) + 1));
    for (size_t i = 0; i < asked->count; i++)
        images->flags[asked->sample[i] % all] = asked->group[i];
    for (size_t i = 0; i < all; i++) {
        images->place[i] = images->flags[i] ? images->count : -1;
        if (images->flags[i])
            images->image[images->count++] = (int)i;
    }
    return WEFT_OK;
}

static size_t values_of(const answers *a, const asked_images *images)
{
    return 3 * (size_t)a->width * (size_t)a->height * (size_t)images->count;
}

static weft_code allocate(answers *a, const asked_images *images, weft_error *error)
{
    size_t count = values_of(a, images);
    for (int i = 0; i < 3; i++) {
        a->value[i] = malloc((count + 1) * sizeof *a->value[i]);
        if (!a->value[i])
            return weft_fail_memory(error, "residuals", count * sizeof *a->value[i]);
        for (size_t k = 0; k < count; k++)
            a->value[i][k] = NAN;
    }
    return WEFT_OK;
}

/* Samples become reflectance times cosine. */
static float cosine_missing(const weft_dataset_layout *layout, int image, size_t texel)
{
    int x = (int)(texel % (size_t)layout->width), y = (int)(texel / (size_t)layout->width);
    return layout->values == WEFT_REFLECTANCE ? (float)weft_dataset_light_direction(layout, image, x, y).z : 1;
}

static void put_answers(const weft_texel_subset *subset, const weft_asked_samples *asked,
                        const weft_asked_samples *moved, const asked_images *images, answers *a)
{
    size_t all = (size_t)subset->layout.image_count;
    for (size_t i = 0; i < asked->count; i++) {
        size_t texel = asked->sample[i] / all, image = asked->sample[i] % all, channel = 0;
        while (channel < i && channel < 2 && asked->sample[i - channel - 1] == asked->sample[i])
            channel++;
        size_t at = 3 * (texel * (size_t)images->count + (size_t)images->place[image]) + channel;
        float factor = cosine_missing(&subset->layout, (int)image, texel);
        a->value[0][at] = factor * asked->value[i].sample;
        a->value[1][at] = factor * asked->value[i].prediction;
        a->value[2][at] = factor * (moved ? moved->value[i].prediction : asked->value[i].prediction);
    }
}

/* ---- Levels ---- */

/* The mean of those of the four that are said, of the value `k` of a texel. */
static float mean_of_four(const answers *fine, int which, int x, int y, size_t k, size_t each)
{
    double sum = 0;
    int count = 0;
    for (int i = 0; i < 4; i++) {
        size_t texel = (size_t)(2 * y + i / 2) * (size_t)fine->width + (size_t)(2 * x + i % 2);
        float value = fine->value[which][texel * each + k];
        if (isnan(value))
            continue;
        sum += (double)value;
        count++;
    }
    return count > 0 ? (float)(sum / count) : NAN;
}

/* Squares of 2 x 2 texels of the finer level; a last row or column that has none beside it is left out. */
static weft_code make_coarser(const answers *fine, const asked_images *images, answers *coarse, weft_error *error)
{
    size_t each = 3 * (size_t)images->count;
    *coarse = (answers){.width = fine->width / 2, .height = fine->height / 2, .level = fine->level + 1};
    WEFT_TRY(allocate(coarse, images, error));
    for (int which = 0; which < 3; which++) {
        float *to = coarse->value[which];
        for (int y = 0; y < coarse->height; y++)
            for (int x = 0; x < coarse->width; x++)
                for (size_t k = 0; k < each; k++)
                    *to++ = mean_of_four(fine, which, x, y, k, each);
    }
    return WEFT_OK;
}

/* ---- Residuals ---- */

static uint8_t ring_of(weft_vec3 direction)
{
    return (uint8_t)weft_ubo81_ring(weft_angles_of_direction(direction).theta_rad);
}

/* The first image of a texel, below `stride`: a sequence that fills it evenly, without a period. */
static int first_of_texel(size_t texel, int stride)
{
    static const double section = 0.6180339887498949;
    return (int)(stride * fmod(section * (double)texel, 1));
}

/* Those of one texel, seen from its centre, in every `stride`-th image: for level `level`. */
static void add_texel(weft_residuals *residuals, const weft_texel_subset *subset, const asked_images *images,
                      const answers *a, size_t texel, int level, int stride, uint32_t first_image)
{
    const weft_dataset_layout *layout = &subset->layout;
    int x = (int)(texel % (size_t)a->width), y = (int)(texel / (size_t)a->width);
    int centre_x = (x << a->level) + (1 << a->level) / 2, centre_y = (y << a->level) + (1 << a->level) / 2;
    for (int i = first_of_texel(texel, stride); i < images->count; i += stride) {
        int image = images->image[i];
        weft_residual residual = {
            .image = first_image + (uint32_t)i,
            .view = ring_of(weft_dataset_view_direction(layout, layout->view_of_image[image], centre_x, centre_y)),
            .light = ring_of(weft_dataset_light_direction(layout, image, centre_x, centre_y)),
            .flags = images->flags[image]};
        for (size_t c = 0; c < 3; c++) {
            size_t at = 3 * (texel * (size_t)images->count + (size_t)i) + c;
            float sample = a->value[0][at], prediction = a->value[1][at];
            if (isnan(sample) || isnan(prediction))
                continue;
            residual.prediction = prediction;
            residual.error = fabsf(sample - prediction);
            residual.moved = fabsf(a->value[2][at] - prediction);
            residuals->value[level][residuals->count[level]++] = residual;
        }
    }
}

static weft_code make_room(weft_residuals *residuals, int level, size_t more, weft_error *error)
{
    size_t wanted = residuals->count[level] + more;
    if (wanted <= residuals->capacity[level])
        return WEFT_OK;
    weft_residual *grown = realloc(residuals->value[level], wanted * sizeof *grown);
    if (!grown)
        return weft_fail_memory(error, "residuals", wanted * sizeof *grown);
    residuals->value[level] = grown;
    residuals->capacity[level] = wanted;
    return WEFT_OK;
}

static bool is_of_level(const answers *a, const weft_residuals_taken *taken, size_t texel, int level)
{
    return taken->level ? taken->level[texel] == level : a->level == level;
}

/* Of those texels of `a` that are of level `level`. */
static weft_code add_level(weft_residuals *residuals, const weft_texel_subset *subset, const asked_images *images,
                           const answers *a, int level, const weft_residuals_taken *taken, weft_error *error)
{
    size_t texels = (size_t)a->width * (size_t)a->height, own = 0;
    for (size_t texel = 0; texel < texels; texel++)
        own += is_of_level(a, taken, texel, level);
    size_t count = 3 * own * (size_t)images->count;
    int stride = weft_larger(1, (int)((count + taken->most - 1) / taken->most));
    if (level < taken->first_level || own == 0)
        return WEFT_OK;
    WEFT_TRY(make_room(residuals, level, count / (size_t)stride + 3 * own, error));
    for (size_t texel = 0; texel < texels; texel++)
        if (is_of_level(a, taken, texel, level))
            add_texel(residuals, subset, images, a, texel, level, stride, taken->first_image);
    residuals->level_count = weft_larger(level + 1, residuals->level_count);
    return WEFT_OK;
}

/* Level after level, as long as there are four squares. */
static weft_code add_levels(weft_residuals *residuals, const weft_texel_subset *subset, const asked_images *images,
                            answers *a, const weft_residuals_taken *taken, weft_error *error)
{
    int last = weft_smaller(taken->last_level, WEFT_RESIDUAL_LEVELS - 1);
    for (int level = 0; taken->level && level <= last; level++)
        WEFT_TRY(add_level(residuals, subset, images, a, level, taken, error));
    if (taken->level)
        return WEFT_OK;
    WEFT_TRY(add_level(residuals, subset, images, a, 0, taken, error));
    while (a->level < last && weft_smaller(a->width, a->height) >= 4) {
        answers coarse = {0};
        weft_code code = make_coarser(a, images, &coarse, error);
        free_answers(a);
        *a = coarse;
        WEFT_TRY(code);
        WEFT_TRY(add_level(residuals, subset, images, a, a->level, taken, error));
    }
    return WEFT_OK;
}

weft_code weft_residuals_add(weft_residuals *residuals, const weft_texel_subset *subset,
                             const weft_asked_samples *asked, const weft_asked_samples *moved,
                             const weft_residuals_taken *taken, weft_error *error)
{
    asked_images images;
    answers a = {.width = subset->layout.width, .height = subset->layout.height};
    weft_code code = find_images(subset, asked, &images, error);
    if (code == WEFT_OK)
        code = allocate(&a, &images, error);
    if (code == WEFT_OK) {
        put_answers(subset, asked, moved, &images, &a);
        code = add_levels(residuals, subset, &images, &a, taken, error);
    }
    free_answers(&a);
    free_images(&images);
    return code;
}
