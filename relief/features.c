#include "relief/features.h"

#include "base/processor.h"
#include "btf/dataset/read_blocks.h"

#include <lapacke.h>
#include <stdlib.h>
#include <string.h>

/* ---- Principal components ---- */

enum { PLACES = 8 }; /* along each side */

typedef struct light_components {
    int length;       /* lights x 3 */
    float *component; /* [length][WEFT_FEATURES] orthonormal columns, the strongest first */
    float *mean;      /* [view_count][length] of every photograph: what stands in for masked samples */
    double explained; /* share of the energy */
} light_components;

/* The texels that the components are made from. */
typedef struct probes {
    weft_half *sample; /* [PLACES * PLACES][image_count][3] */
    uint8_t *mask;     /* [PLACES * PLACES][image_count] */
    size_t images;
} probes;

static weft_code read_probes(weft_dataset *dataset, probes *p, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    p->images = (size_t)layout->image_count;
    size_t count = PLACES * PLACES * p->images;
    p->sample = malloc(3 * count * sizeof *p->sample);
    p->mask = malloc(count);
    if (!p->sample || !p->mask)
        return weft_fail_memory(error, "texels", 7 * count);
    for (int i = 0; i < PLACES * PLACES; i++) {
        int x = (2 * (i % PLACES) + 1) * layout->width / (2 * PLACES);
        int y = (2 * (i / PLACES) + 1) * layout->height / (2 * PLACES);
        WEFT_TRY(weft_dataset_read_block(dataset, x, y, 1, 1, p->sample + 3 * (size_t)i * p->images,
                                         p->mask + (size_t)i * p->images, error));
    }
    return WEFT_OK;
}

static void free_probes(probes *p)
{
    free(p->sample);
    free(p->mask);
}

/* ---- Means of the photographs ---- */

static void find_mean(const probes *p, const weft_relief_views *views, int view, float *mean)
{
    const int *image = views->image + (long)view * views->light_count;
    for (int i = 0; i < views->light_count; i++) {
        float sum[3] = {0}, count = 0;
        for (size_t place = 0; place < PLACES * PLACES; place++) {
            size_t at = place * p->images + (size_t)image[i];
            if (p->mask[at])
                continue;
            count++;
            for (size_t c = 0; c < 3; c++)
                sum[c] += weft_float_of_half(p->sample[3 * at + c]);
        }
        for (int c = 0; c < 3; c++)
            mean[3 * i + c] = count > 0 ? sum[c] / count * views->cosine[i] : 0;
    }
}

/* The light vector of a view in a texel: value [length] from sample [image_count][3] and mask [image_count], masked
 * ones from the mean, as bright as the others are to theirs; false where more than a quarter of them are masked. */
static bool light_vector(const weft_relief_views *views, const light_components *components, int view,
                         const weft_half *sample, const uint8_t *mask, float *value)
{
    const int *image = views->image + (long)view * views->light_count;
    const float *mean = components->mean + (long)view * components->length;
    int masked = 0;
    float product = 0, square = 0;
    for (int i = 0; i < views->light_count; i++) {
        const weft_half *rgb = sample + 3 * (size_t)image[i];
        masked += mask[image[i]] != 0;
        for (int c = 0; c < 3 && !mask[image[i]]; c++) {
            value[3 * i + c] = weft_float_of_half(rgb[c]) * views->cosine[i];
            product += value[3 * i + c] * mean[3 * i + c];
            square += mean[3 * i + c] * mean[3 * i + c];
        }
    }
    float brightness = square > 0 ? product / square : 1;
    for (int i = 0; i < views->light_count && masked > 0; i++)
        for (int c = 0; c < 3 && mask[image[i]]; c++)
            value[3 * i + c] = brightness * mean[3 * i + c];
    return 4 * masked <= views->light_count;
}

/* ---- Components ---- */

/* Adds value value^T, of which the lower triangle is kept. */
static void add_product(const float *value, int length, double *matrix)
{
    for (int i = 0; i < length; i++) {
        double *row = matrix + (size_t)i * (size_t)length;
        for (int j = 0; j <= i; j++)
            row[j] += (double)(value[i] * value[j]);
    }
}

/* The second moments of all light vectors of the probes; returns how many were known. */
static long add_moments(const probes *p, const weft_relief_views *views, const light_components *components,
                        float *value, double *matrix)
{
    long count = 0;
    for (int view = 0; view < views->view_count; view++) {
        for (size_t place = 0; place < PLACES * PLACES; place++) {
            if (!light_vector(views, components, view, p->sample + 3 * place * p->images, p->mask + place * p->images,
                              value))
                continue;
            add_product(value, components->length, matrix);
            count++;
        }
    }
    return count;
}

static double trace_of(const double *matrix, int length)
{
    double sum = 0;
    for (int i = 0; i < length; i++)
        sum += matrix[(size_t)i * (size_t)length + (size_t)i];
    return sum;
}

/* `vector` [length][found] with ascending values, to the columns of the components, descending. */
static weft_code solve(double *matrix, light_components *components, double *vector, weft_error *error)
{
    lapack_int n = components->length, found = 0, support[2 * WEFT_FEATURES];
    lapack_int wanted = n < WEFT_FEATURES ? n : WEFT_FEATURES;
    double *value = malloc((size_t)n * sizeof *value), trace = trace_of(matrix, n), sum = 0;
    if (!value)
        return weft_fail_memory(error, "eigenvalues", (size_t)n * sizeof *value);
    bool done = LAPACKE_dsyevr(LAPACK_ROW_MAJOR, 'V', 'I', 'L', n, matrix, n, 0, 0, n - wanted + 1, n, 0, &found, value,
                               vector, wanted, support) == 0 &&
                found == wanted;
    for (lapack_int k = 0; done && k < wanted; k++) {
        sum += fmax(value[wanted - 1 - k], 0);
        for (lapack_int i = 0; i < n; i++)
            components->component[WEFT_FEATURES * i + k] = (float)vector[i * wanted + wanted - 1 - k];
    }
    free(value);
    components->explained = sum / trace;
    return done ? WEFT_OK : weft_fail(error, WEFT_SYSTEM, "the components of %d values could not be computed", (int)n);
}

static weft_code find_moments(const probes *p, const weft_relief_views *views, const char *path,
                              light_components *components, weft_error *error)
{
    size_t n = (size_t)components->length;
    double *matrix = calloc(n * n, sizeof *matrix), *vector = calloc(n * WEFT_FEATURES, sizeof *vector);
    float *value = malloc(n * sizeof *value);
    weft_code code = WEFT_OK;
    if (!matrix || !vector || !value)
        code = weft_fail_memory(error, "products of lights", n * n * sizeof *matrix);
    else if (add_moments(p, views, components, value, matrix) == 0)
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s': too many samples are masked for heights", path);
    else if (!(trace_of(matrix, components->length) > 0))
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s' is black all over: it shows no heights", path);
    else
        code = solve(matrix, components, vector, error);
    free(matrix);
    free(vector);
    free(value);
    return code;
}

static void free_components(light_components *components)
{
    free(components->component);
    free(components->mean);
    *components = (light_components){0};
}

static weft_code allocate_components(const weft_relief_views *views, light_components *components, weft_error *error)
{
    components->length = 3 * views->light_count;
    size_t length = (size_t)components->length, means = (size_t)views->view_count * length;
    components->component = calloc(length * WEFT_FEATURES, sizeof *components->component);
    components->mean = malloc(means * sizeof *components->mean);
    return components->component && components->mean ? WEFT_OK : weft_fail_memory(error, "components", 4 * means);
}

/* From the texels of 8 x 8 places spread over the material, in all views. Not centred: what is compared later are
 * differences, whose energy the mean would not change. */
static weft_code find_components(weft_dataset *dataset, const weft_relief_views *views, light_components *components,
                                 weft_error *error)
{
    probes p = {0};
    *components = (light_components){0};
    weft_code code = allocate_components(views, components, error);
    if (code == WEFT_OK)
        code = read_probes(dataset, &p, error);
    for (int view = 0; code == WEFT_OK && view < views->view_count; view++)
        find_mean(&p, views, view, components->mean + (long)view * components->length);
    if (code == WEFT_OK)
        code = find_moments(&p, views, weft_dataset_path(dataset), components, error);
    free_probes(&p);
    if (code != WEFT_OK)
        free_components(components);
    return code;
}

/* ---- Reading ---- */

typedef struct reading {
    const weft_relief_views *views;
    const light_components *components;
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
        features->known[at] = light_vector(r->views, r->components, view, sample, mask, value);
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
    light_components components;
    WEFT_TRY(find_components(dataset, views, &components, error));
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
    free_components(&components);
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
