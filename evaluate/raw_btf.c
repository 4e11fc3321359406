#include "evaluate/model.h"

#include "btf/dataset/dataset.h"
#include "evaluate/raw_directions.h"
#include "evaluate/texels_around.h"
#include "reflectance/relief/relief.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

struct weft_raw_btf {
    weft_dataset *dataset;
    const weft_dataset_layout *layout;
    weft_view_order order;
    weft_raw_directions centre; /* everywhere in a far dataset */
    weft_half *samples;         /* [image_count][3] of a texel */
    uint8_t *mask;              /* [image_count] of a texel */
    weft_dataset_heights heights;
    weft_relief relief; /* through which samples are seen; of no view where there are no heights */
    float *mean;        /* [image_count][3]; NULL until asked for */
    uint8_t *mean_mask; /* [image_count] */
};

/* ---- Life ---- */

static weft_code open_relief(weft_raw_btf *raw, weft_error *error)
{
    double size_mm[2];
    WEFT_TRY(weft_dataset_read_surface(raw->dataset, &raw->heights, error));
    if (!raw->heights.value)
        return WEFT_OK;
    weft_dataset_size_mm(raw->layout, size_mm);
    weft_height_field field =
        weft_height_field_of(raw->heights.value, raw->heights.width, raw->heights.height, size_mm[0], size_mm[1]);
    return weft_relief_create(&field, raw->layout->view, raw->layout->view_count, &raw->relief, error);
}

weft_code weft_raw_btf_create(weft_dataset *dataset, weft_raw_btf **result, weft_error *error)
{
    weft_raw_btf *raw = calloc(1, sizeof *raw);
    if (!raw)
        return weft_fail_memory(error, "dataset", sizeof *raw);
    raw->dataset = dataset;
    raw->layout = weft_dataset_get_layout(dataset);
    size_t images = (size_t)raw->layout->image_count;
    raw->samples = malloc(3 * images * sizeof *raw->samples);
    raw->mask = malloc(images);
    weft_code code = WEFT_OK;
    if (!raw->samples || !raw->mask)
        code = weft_fail_memory(error, "texel", images * 7);
    if (code == WEFT_OK)
        code = weft_view_order_create(raw->layout, NULL, &raw->order, error);
    if (code == WEFT_OK)
        code = weft_raw_directions_create(raw->layout, &raw->order, raw->layout->width / 2, raw->layout->height / 2,
                                          &raw->centre, error);
    if (code == WEFT_OK)
        code = open_relief(raw, error);
    if (code != WEFT_OK)
        weft_raw_btf_free(raw);
    else
        *result = raw;
    return code;
}

void weft_raw_btf_free(weft_raw_btf *raw)
{
    if (!raw)
        return;
    weft_raw_directions_free(&raw->centre);
    weft_view_order_free(&raw->order);
    weft_relief_free(&raw->relief);
    weft_dataset_heights_free(&raw->heights);
    free(raw->samples);
    free(raw->mask);
    free(raw->mean);
    free(raw->mean_mask);
    free(raw);
}

void weft_raw_btf_flatten(weft_raw_btf *raw)
{
    weft_relief_free(&raw->relief);
    weft_dataset_heights_free(&raw->heights);
}

/* ---- Interpolation ---- */

/* Weighted sum of valid samples: BRDF x pi in [0..2], the sum of the weights in [3]. */
typedef struct blend {
    double sum[4];
} blend;

static void blend_add(blend *b, double weight, const double value[3])
{
    for (int c = 0; c < 3; c++)
        b->sum[c] += weight * value[c];
    b->sum[3] += weight;
}

static weft_rgb blend_brdf(const blend *b)
{
    double scale = b->sum[3] > 0 ? 1 / (WEFT_PI * b->sum[3]) : NAN;
    return (weft_rgb){b->sum[0] * scale, b->sum[1] * scale, b->sum[2] * scale};
}

/* The samples of one place: half floats of a texel, or the float means. */
typedef struct place {
    const weft_half *half;
    const float *mean;
    const uint8_t *mask;
    int x, y;
} place;

static void add_image(const weft_raw_btf *raw, const place *at, int image, double weight, blend *b)
{
    double cosine = 1;
    if (raw->layout->values == WEFT_REFLECTANCE_COSINE)
        cosine = weft_dataset_light_direction(raw->layout, image, at->x, at->y).z;
    if (at->mask[image] || !(cosine > 0))
        return;
    double value[3];
    for (int c = 0; c < 3; c++) {
        size_t index = 3 * (size_t)image + (size_t)c;
        value[c] = (double)(at->mean ? at->mean[index] : weft_float_of_half(at->half[index])) / cosine;
    }
    blend_add(b, weight, value);
}

static void interpolate(const weft_raw_btf *raw, const weft_raw_directions *d, const place *at, weft_vec3 light,
                        weft_vec3 view, blend *b)
{
    weft_raw_stencil stencil = weft_raw_stencil_of(d, &raw->order, light, view);
    for (int i = 0; i < stencil.count; i++)
        add_image(raw, at, stencil.image[i], stencil.weight[i], b);
}

static weft_code sample_texel(weft_raw_btf *raw, int x, int y, weft_vec3 light, weft_vec3 view, weft_rgb *brdf,
                              weft_error *error)
{
    WEFT_TRY(weft_dataset_read_block(raw->dataset, x, y, 1, 1, raw->samples, raw->mask, error));
    place at = {.half = raw->samples, .mask = raw->mask, .x = x, .y = y};
    blend b = {0};
    if (raw->layout->distance == WEFT_FAR) {
        interpolate(raw, &raw->centre, &at, light, view, &b);
    } else {
        weft_raw_directions near;
        WEFT_TRY(weft_raw_directions_create(raw->layout, &raw->order, x, y, &near, error));
        interpolate(raw, &near, &at, light, view, &b);
        weft_raw_directions_free(&near);
    }
    *brdf = blend_brdf(&b);
    return WEFT_OK;
}

static bool below_horizon(weft_vec3 light, weft_vec3 view)
{
    return !(light.z > 0 && view.z > 0);
}

/* ---- Through heights ---- */

/* The samples of one view in a texel, between its lights. */
static weft_code add_view(weft_raw_btf *raw, int view, int x, int y, weft_vec3 light, double weight, blend *b,
                          weft_error *error)
{
    WEFT_TRY(weft_dataset_read_block(raw->dataset, x, y, 1, 1, raw->samples, raw->mask, error));
    place at = {.half = raw->samples, .mask = raw->mask, .x = x, .y = y};
    weft_barycentric lights = weft_triangulation_lookup(raw->centre.lights[view], light);
    const int *image = raw->order.image + raw->order.first[view];
    for (int i = 0; i < 3; i++)
        if (lights.index[i] >= 0 && lights.weight[i] > 0)
            add_image(raw, &at, image[lights.index[i]], weight * (double)lights.weight[i], b);
    return WEFT_OK;
}

static weft_code sample_through_relief(weft_raw_btf *raw, weft_real u, weft_real v, weft_vec3 light, weft_vec3 view,
                                       weft_rgb *brdf, weft_error *error)
{
    weft_barycentric corners = weft_triangulation_lookup(raw->centre.views, view);
    weft_relief_tap tap[3];
    blend b = {0};
    for (int i = 0; i < 3; i++)
        corners.index[i] = corners.index[i] < 0 ? -1 : raw->centre.view_of[corners.index[i]];
    weft_relief_taps(&raw->relief, 1, u, v, view, corners.index, corners.weight, tap);
    for (int i = 0; i < 3; i++) {
        weft_texels_around at = weft_texels_around_place(raw->layout, tap[i].u, tap[i].v);
        for (int k = 0; k < 4 && tap[i].weight > 0; k++)
            if (at.weight[k] > 0)
                WEFT_TRY(add_view(raw, corners.index[i], at.x[k], at.y[k], light, (double)tap[i].weight * at.weight[k],
                                  &b, error));
    }
    *brdf = blend_brdf(&b);
    return WEFT_OK;
}

weft_code weft_raw_btf_sample(weft_raw_btf *raw, weft_real u, weft_real v, weft_vec3 light, weft_vec3 view,
                              weft_rgb *brdf, weft_error *error)
{
    *brdf = (weft_rgb){0, 0, 0};
    if (below_horizon(light, view))
        return WEFT_OK;
    if (raw->heights.value)
        return sample_through_relief(raw, u, v, light, view, brdf, error);
    weft_texels_around at = weft_texels_around_place(raw->layout, u, v);
    blend b = {0};
    for (int i = 0; i < 4; i++) {
        weft_rgb value;
        if (!(at.weight[i] > 0))
            continue;
        WEFT_TRY(sample_texel(raw, at.x[i], at.y[i], light, view, &value, error));
        if (!isnan(value.r))
            blend_add(&b, at.weight[i], (double[]){WEFT_PI * value.r, WEFT_PI * value.g, WEFT_PI * value.b});
    }
    *brdf = blend_brdf(&b);
    return WEFT_OK;
}

/* ---- Mean of all texels ---- */

static void add_texel(int image_count, const weft_half *samples, const uint8_t *mask, double *sum, long *count)
{
    for (int i = 0; i < image_count; i++) {
        if (mask[i])
            continue;
        for (int c = 0; c < 3; c++)
            sum[3 * i + c] += (double)weft_float_of_half(samples[3 * i + c]);
        count[i]++;
    }
}

static weft_code sum_texels(weft_raw_btf *raw, double *sum, long *count, weft_error *error)
{
    const weft_dataset_layout *layout = raw->layout;
    int band = weft_dataset_rows_at_once(layout);
    size_t images = (size_t)layout->image_count, most = (size_t)band * (size_t)layout->width * images;
    weft_half *samples = malloc(3 * most * sizeof *samples);
    uint8_t *mask = malloc(most);
    weft_code code = samples && mask ? WEFT_OK : weft_fail_memory(error, "rows of texels", 7 * most);
    for (int y = 0; y < layout->height && code == WEFT_OK; y += band) {
        int rows = band < layout->height - y ? band : layout->height - y;
        code = weft_dataset_read_block(raw->dataset, 0, y, layout->width, rows, samples, mask, error);
        for (size_t t = 0; code == WEFT_OK && t < (size_t)rows * (size_t)layout->width; t++)
            add_texel(layout->image_count, samples + 3 * t * images, mask + t * images, sum, count);
    }
    free(samples);
    free(mask);
    return code;
}

static weft_code read_mean(weft_raw_btf *raw, weft_error *error)
{
    size_t images = (size_t)raw->layout->image_count;
    double *sum = calloc(3 * images, sizeof *sum);
    long *count = calloc(images, sizeof *count);
    raw->mean = malloc(3 * images * sizeof *raw->mean);
    raw->mean_mask = malloc(images);
    weft_code code = WEFT_OK;
    if (!sum || !count || !raw->mean || !raw->mean_mask)
        code = weft_fail_memory(error, "mean", 3 * images * sizeof *sum);
    else
        code = sum_texels(raw, sum, count, error);
    for (size_t i = 0; code == WEFT_OK && i < images; i++) {
        raw->mean_mask[i] = count[i] == 0;
        for (size_t c = 0; c < 3; c++)
            raw->mean[3 * i + c] = count[i] ? (float)(sum[3 * i + c] / (double)count[i]) : 0;
    }
    free(sum);
    free(count);
    if (code != WEFT_OK) {
        free(raw->mean);
        raw->mean = NULL;
    }
    return code;
}

weft_code weft_raw_btf_mean(weft_raw_btf *raw, weft_vec3 light, weft_vec3 view, weft_rgb *brdf, weft_error *error)
{
    *brdf = (weft_rgb){0, 0, 0};
    if (below_horizon(light, view))
        return WEFT_OK;
    if (!raw->mean)
        WEFT_TRY(read_mean(raw, error));
    place at = {.mean = raw->mean, .mask = raw->mean_mask, .x = raw->layout->width / 2, .y = raw->layout->height / 2};
    blend b = {0};
    interpolate(raw, &raw->centre, &at, light, view, &b);
    *brdf = blend_brdf(&b);
    return WEFT_OK;
}
