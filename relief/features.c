#include "relief/features.h"

#include "base/processor.h"
#include "btf/dataset/read_blocks.h"
#include "relief/components.h"

#include <stdlib.h>
#include <string.h>

/* ---- Reading ---- */

typedef struct reading {
    const weft_relief_views *views;
    const weft_light_components *components;
    weft_features *features;
    size_t images;
    weft_feature_project *project;
} reading;

static void read_texel(const reading *r, const weft_walk_block *block, int i, float *value)
{
    const weft_features *features = r->features;
    int column = block->x + i % block->width, row = block->y + i / block->width;
    size_t x = (size_t)column, y = (size_t)row;
    const weft_half *sample = block->samples + 3 * (size_t)i * r->images;
    const uint8_t *mask = block->mask + (size_t)i * r->images;
    for (int view = 0; view < features->view_count; view++) {
        size_t at = ((size_t)view * (size_t)features->height + y) * (size_t)features->width + x;
        features->known[at] = weft_light_vector(r->views, r->components, view, sample, mask, value);
        r->project(value, r->components->component, r->components->length, features->value + WEFT_FEATURES * at);
    }
}

static void read_block(void *context, const weft_walk_block *block)
{
    const reading *r = context;
#pragma omp parallel for schedule(dynamic, 8)
    for (int i = 0; i < block->width * block->height; i++) {
        float value[3 * WEFT_MOST_LIGHTS];
        read_texel(r, block, i, value);
    }
}

/* Nothing is kept where nothing is masked. */
static void drop_known(weft_features *features)
{
    size_t count = (size_t)features->view_count * (size_t)features->height * (size_t)features->width;
    if (memchr(features->known, 0, count))
        return;
    free(features->known);
    features->known = NULL;
}

static weft_code allocate(weft_features *features, weft_error *error)
{
    size_t count = (size_t)features->view_count * (size_t)features->height * (size_t)features->width;
    features->value = malloc(count * WEFT_FEATURES * sizeof *features->value);
    features->known = malloc(count);
    return features->value && features->known ? WEFT_OK
                                              : weft_fail_memory(error, "features", count * WEFT_FEATURES * 4);
}

static weft_code read_all(weft_dataset *dataset, const weft_relief_views *views, const weft_progress *progress,
                          weft_features *features, weft_error *error)
{
    weft_light_components components;
    WEFT_TRY(weft_light_components_find(dataset, views, &components, error));
    features->explained = components.explained;
    reading r = {.views = views,
                 .components = &components,
                 .features = features,
                 .images = (size_t)weft_dataset_get_layout(dataset)->image_count,
                 .project = WEFT_DISPATCH(weft_feature_project)};
    weft_code code = allocate(features, error);
    if (code == WEFT_OK)
        code = weft_walk_blocks(dataset, read_block, &r, "reading photographs", progress, error);
    if (code == WEFT_OK)
        drop_known(features);
    weft_light_components_free(&components);
    return code;
}

weft_code weft_features_read(weft_dataset *dataset, const weft_relief_views *views, const weft_progress *progress,
                             weft_features *features, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    double size_mm[2];
    weft_dataset_size_mm(layout, size_mm);
    *features = (weft_features){.width = layout->width,
                                .height = layout->height,
                                .view_count = views->view_count,
                                .width_mm = size_mm[0],
                                .height_mm = size_mm[1],
                                .direction = views->direction};
    weft_code code = read_all(dataset, views, progress, features, error);
    if (code != WEFT_OK)
        weft_features_free(features);
    return code;
}

void weft_features_free(weft_features *features)
{
    free(features->value);
    free(features->known);
    *features = (weft_features){0};
}

/* ---- Levels ---- */

/* The mean of the four texels above (x, y) that are known; false where none is. */
static bool mean_of_four(const weft_features *features, int view, int x, int y, float *mean)
{
    float count = 0;
    memset(mean, 0, WEFT_FEATURES * sizeof *mean);
    for (int i = 0; i < 4; i++) {
        int from_x = 2 * x + (i & 1), from_y = 2 * y + (i >> 1);
        const float *from = weft_feature_at(features, view, from_x, from_y);
        if (!weft_feature_known(features, view, from_x, from_y))
            continue;
        count++;
        for (int k = 0; k < WEFT_FEATURES; k++)
            mean[k] += from[k];
    }
    for (int k = 0; k < WEFT_FEATURES; k++)
        mean[k] /= fmaxf(count, 1);
    return count > 0;
}

weft_code weft_features_halve(const weft_features *features, weft_features *half, weft_error *error)
{
    *half = *features;
    half->width = features->width / 2;
    half->height = features->height / 2;
    half->width_mm *= 2.0 * half->width / features->width;
    half->height_mm *= 2.0 * half->height / features->height;
    half->value = NULL;
    half->known = NULL;
    weft_code code = allocate(half, error);
    if (code != WEFT_OK) {
        weft_features_free(half);
        return code;
    }
    size_t at = 0;
    for (int view = 0; view < half->view_count; view++)
        for (int y = 0; y < half->height; y++)
            for (int x = 0; x < half->width; x++, at++)
                half->known[at] = mean_of_four(features, view, x, y, half->value + WEFT_FEATURES * at);
    drop_known(half);
    return WEFT_OK;
}

/* ---- Borders ---- */

static double difference(const weft_features *features, int view, int x, int y, int other_x, int other_y)
{
    const float *a = weft_feature_at(features, view, x, y), *b = weft_feature_at(features, view, other_x, other_y);
    double sum = 0;
    for (int k = 0; k < WEFT_FEATURES; k++)
        sum += (double)((a[k] - b[k]) * (a[k] - b[k]));
    return sum;
}

double weft_features_seam(const weft_features *features)
{
    int width = features->width, height = features->height;
    double across = 0, inside = 0, across_count = 0, inside_count = 0;
    for (int view = 0; view < features->view_count; view++) {
        for (int y = 0; y < height; y++) {
            for (int x = 0; x < width; x++) {
                double right = difference(features, view, x, y, (x + 1) % width, y);
                double down = difference(features, view, x, y, x, (y + 1) % height);
                *(x + 1 == width ? &across : &inside) += right;
                *(y + 1 == height ? &across : &inside) += down;
            }
        }
    }
    across_count = (double)width + height;
    inside_count = 2.0 * width * height - across_count;
    return inside > 0 && inside_count > 0 ? across / across_count / (inside / inside_count) : 1;
}
