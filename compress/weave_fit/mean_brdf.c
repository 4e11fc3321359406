#include "compress/weave_fit/fit_weave.h"

#include "btf/dataset/read_blocks.h"

#include <math.h>
#include <stdlib.h>

/* Sums over the valid texels of every image, weighted. */
typedef struct sums {
    double (*rgb)[3];
    double *count;
} sums;

/* Integral of 1 / n from the beginning of a window to `at` within it, n how often the window of that size shows the
 * place in the period. */
static double weight_before(double at, double size, double period)
{
    if (!(period > 0 && period < size))
        return at;
    double times = floor(size / period), rest = size - times * period, turns = floor(at / period);
    double into = at - turns * period, often = fmin(into, rest) / (times + 1), seldom = fmax(into - rest, 0) / times;
    return turns * (rest / (times + 1) + (period - rest) / times) + often + seldom;
}

/* What texel [at, at + 1) counts in a window along one axis. */
static double weight_of(int at, double low, double size, double period)
{
    double from = fmin(fmax(at - low, 0), size), to = fmin(fmax(at + 1 - low, 0), size);
    return from < to ? weight_before(to, size, period) - weight_before(from, size, period) : 0;
}

/* One texel, `weight` of which counts. */
static void add_texel(const weft_half *samples, const uint8_t *mask, size_t images, double weight, sums *of)
{
    for (size_t image = 0; image < images; image++) {
        if (mask[image])
            continue;
        for (size_t k = 0; k < 3; k++)
            of->rgb[image][k] += weight * (double)weft_float_of_half(samples[3 * image + k]);
        of->count[image] += weight;
    }
}

/* What the pass over the blocks carries along. */
typedef struct averaging {
    const weft_texel_window *window;
    size_t images;
    sums *of;
} averaging;

static void add_block(void *context, const weft_walk_block *at)
{
    const averaging *a = context;
    for (int i = 0; i < at->width * at->height; i++) {
        size_t first = (size_t)i * a->images;
        double weight = weight_of(at->x + i % at->width, a->window->left, a->window->width, a->window->period_x) *
                        weight_of(at->y + i / at->width, a->window->top, a->window->height, a->window->period_y);
        if (weight > 0)
            add_texel(at->samples + 3 * first, at->mask + first, a->images, weight, a->of);
    }
}

static void append_image(const weft_dataset_layout *layout, int image, const sums *of, weft_mean_brdf *mean)
{
    int x = layout->width / 2, y = layout->height / 2;
    weft_vec3 light = weft_dataset_light_direction(layout, image, x, y);
    weft_vec3 view = weft_dataset_view_direction(layout, layout->view_of_image[image], x, y);
    if (!(of->count[image] > 0 && light.z > 0 && view.z > 0))
        return;
    double scale = 1 / (of->count[image] * WEFT_PI);
    if (layout->values == WEFT_REFLECTANCE_COSINE)
        scale /= light.z;
    const double *rgb = of->rgb[image];
    mean->light[mean->count] = light;
    mean->view[mean->count] = view;
    mean->value[mean->count] = (weft_rgb){rgb[0] * scale, rgb[1] * scale, rgb[2] * scale};
    mean->count++;
}

weft_code weft_mean_brdf_of(weft_dataset *dataset, const weft_texel_window *window, const weft_progress *progress,
                            weft_mean_brdf *mean, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    const weft_texel_window all = {.width = layout->width, .height = layout->height};
    size_t images = (size_t)layout->image_count;
    *mean = (weft_mean_brdf){.light = calloc(images, sizeof *mean->light),
                             .view = calloc(images, sizeof *mean->view),
                             .value = calloc(images, sizeof *mean->value)};
    sums of = {.rgb = calloc(images, sizeof *of.rgb), .count = calloc(images, sizeof *of.count)};
    weft_code code = WEFT_OK;
    if (!mean->light || !mean->view || !mean->value || !of.rgb || !of.count)
        code = weft_fail_memory(error, "mean of the images", images * (sizeof *of.rgb + sizeof *mean->value));
    averaging a = {.window = window ? window : &all, .images = images, .of = &of};
    if (code == WEFT_OK)
        code = weft_walk_blocks(dataset, add_block, &a, "reading rows", progress, error);
    for (int image = 0; code == WEFT_OK && image < layout->image_count; image++)
        append_image(layout, image, &of, mean);
    if (code == WEFT_OK && mean->count == 0)
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s' holds no valid sample", weft_dataset_path(dataset));
    free(of.rgb);
    free(of.count);
    if (code != WEFT_OK)
        weft_mean_brdf_free(mean);
    return code;
}

void weft_mean_brdf_free(weft_mean_brdf *mean)
{
    free(mean->light);
    free(mean->view);
    free(mean->value);
    *mean = (weft_mean_brdf){0};
}
