#include "relief/components.h"

#include <lapacke.h>
#include <stdlib.h>
#include <string.h>

enum { PLACES = 8 }; /* along each side */

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

bool weft_light_vector(const weft_relief_views *views, const weft_light_components *components, int view,
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
static long add_moments(const probes *p, const weft_relief_views *views, const weft_light_components *components,
                        float *value, double *matrix)
{
    long count = 0;
    for (int view = 0; view < views->view_count; view++) {
        for (size_t place = 0; place < PLACES * PLACES; place++) {
            if (!weft_light_vector(views, components, view, p->sample + 3 * place * p->images,
                                   p->mask + place * p->images, value))
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
static weft_code solve(double *matrix, weft_light_components *components, double *vector, weft_error *error)
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

static weft_code find(const probes *p, const weft_relief_views *views, const char *path,
                      weft_light_components *components, weft_error *error)
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

static weft_code allocate(const weft_relief_views *views, weft_light_components *components, weft_error *error)
{
    components->length = 3 * views->light_count;
    size_t length = (size_t)components->length, means = (size_t)views->view_count * length;
    components->component = calloc(length * WEFT_FEATURES, sizeof *components->component);
    components->mean = malloc(means * sizeof *components->mean);
    return components->component && components->mean ? WEFT_OK : weft_fail_memory(error, "components", 4 * means);
}

weft_code weft_light_components_find(weft_dataset *dataset, const weft_relief_views *views,
                                     weft_light_components *components, weft_error *error)
{
    probes p = {0};
    *components = (weft_light_components){0};
    weft_code code = allocate(views, components, error);
    if (code == WEFT_OK)
        code = read_probes(dataset, &p, error);
    for (int view = 0; code == WEFT_OK && view < views->view_count; view++)
        find_mean(&p, views, view, components->mean + (long)view * components->length);
    if (code == WEFT_OK)
        code = find(&p, views, weft_dataset_path(dataset), components, error);
    free_probes(&p);
    if (code != WEFT_OK)
        weft_light_components_free(components);
    return code;
}

void weft_light_components_free(weft_light_components *components)
{
    free(components->component);
    free(components->mean);
    *components = (weft_light_components){0};
}
