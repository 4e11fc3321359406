#include "compress/components/projection.h"

#include "base/numeric/cholesky.h"
#include "base/real.h"
#include "compress/options/options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Steps of the finer components in one of the others. */
enum { FINER = 2 * WEFT_COMPONENTS_LARGEST_CODE };

/* The level that is being written, in place over the one below. */
typedef struct pyramid {
    int width, height;
    size_t component_count;
    float *coefficient, *brightest, *floor;
} pyramid;

/* The largest coefficient of level 0 gets the largest code; means are never larger. */
static void find_steps(const pyramid *p, float step[WEFT_COMPONENTS_MAX])
{
    size_t texels = (size_t)p->width * (size_t)p->height;
    for (size_t k = 0; k < p->component_count; k++) {
        float most = 0;
        for (size_t texel = 0; texel < texels; texel++)
            most = fmaxf(most, fabsf(p->coefficient[texel * p->component_count + k]));
        step[k] = most / WEFT_COMPONENTS_LARGEST_CODE;
    }
}

static int8_t *code_of(weft_components_level *level, size_t layer, size_t texel)
{
    size_t texels = (size_t)level->width * (size_t)level->height;
    return level->coefficient + (layer / WEFT_COMPONENTS_GROUP * texels + texel) * WEFT_COMPONENTS_GROUP +
           layer % WEFT_COMPONENTS_GROUP;
}

/* What rounding leaves is at most half a step, which the finer layer, where there is one, has as its largest code. */
static void write_codes(const pyramid *p, const float step[WEFT_COMPONENTS_MAX], bool has_finer,
                        weft_components_level *level)
{
    size_t texels = (size_t)p->width * (size_t)p->height;
    for (size_t k = 0; k < p->component_count; k++)
        for (size_t texel = 0; texel < texels; texel++) {
            float value = step[k] > 0 ? p->coefficient[texel * p->component_count + k] / step[k] : 0;
            float whole = fminf(fmaxf(roundf(value), -WEFT_COMPONENTS_LARGEST_CODE), WEFT_COMPONENTS_LARGEST_CODE);
            *code_of(level, k, texel) = (int8_t)whole;
            if (has_finer)
                *code_of(level, p->component_count + k, texel) =
                    (int8_t)lroundf(fminf(fmaxf(value - whole, -0.5f), 0.5f) * FINER);
        }
}

static float brightest_in(const pyramid *p, int x0, int y0)
{
    float most = 0;
    for (int y = y0; y < y0 + WEFT_CEILING_SIDE && y < p->height; y++)
        for (int x = x0; x < x0 + WEFT_CEILING_SIDE && x < p->width; x++)
            most = fmaxf(most, p->brightest[(size_t)y * (size_t)p->width + (size_t)x]);
    return most;
}

static void write_ceilings(const pyramid *p, uint8_t *code)
{
    for (int y = 0; y < p->height; y += WEFT_CEILING_SIDE)
        for (int x = 0; x < p->width; x += WEFT_CEILING_SIDE)
            *code++ = weft_ceiling_code(WEFT_BRIGHTEST_MULTIPLE * brightest_in(p, x, y));
}

static float darkest_in(const pyramid *p, int x0, int y0, size_t channel)
{
    float least = INFINITY;
    for (int y = y0; y < y0 + WEFT_CEILING_SIDE && y < p->height; y++)
        for (int x = x0; x < x0 + WEFT_CEILING_SIDE && x < p->width; x++)
            least = fminf(least, p->floor[3 * ((size_t)y * (size_t)p->width + (size_t)x) + channel]);
    return least;
}

static void write_floors(const pyramid *p, uint8_t *code)
{
    for (int y = 0; y < p->height; y += WEFT_CEILING_SIDE)
        for (int x = 0; x < p->width; x += WEFT_CEILING_SIDE)
            for (size_t c = 0; c < 3; c++)
                *code++ = weft_floor_code(darkest_in(p, x, y, c));
}

/* How many texels of level 0 along a side the texel at `index` of a level covers. */
static int covered(int index, int level, int size)
{
    int first = index << level, last = (index + 1) << level;
    return (last < size ? last : size) - first;
}

/* ---- The mean of coded values ---- */

enum { MOST_IMAGES = 512 };

/* What components give at some of the images. */
typedef struct decoder {
    float exponent;
    size_t count, length; /* components, and values: three of each image */
    float *factor;        /* [count][length] */
    double *root;         /* [count][count] Cholesky's factor of their products */
} decoder;

static void decoder_free(decoder *d)
{
    free(d->factor);
    free(d->root);
}

static void fill_decoder(const weft_component_images *images, const float *factor, decoder *d)
{
    size_t taken = d->length / 3;
    for (size_t k = 0; k < d->count; k++)
        for (size_t i = 0; i < taken; i++) {
            size_t image = i * (size_t)images->image_count / taken;
            for (size_t c = 0; c < 3; c++)
                d->factor[k * d->length + 3 * i + c] =
                    factor[k * images->length + 3 * image + c] / images->weight[image];
        }
}

/* False where the components are nothing at these images. */
static bool factor_products(decoder *d)
{
    static const double ridge = 1e-6; /* of the largest product */
    double most = 0;
    for (size_t i = 0; i < d->count; i++)
        for (size_t j = 0; j <= i; j++) {
            double sum = 0;
            for (size_t s = 0; s < d->length; s++)
                sum += (double)d->factor[i * d->length + s] * (double)d->factor[j * d->length + s];
            d->root[i * d->count + j] = sum;
            most = fmax(most, sum);
        }
    for (size_t i = 0; i < d->count; i++)
        d->root[i * d->count + i] += ridge * most;
    return weft_cholesky_factor((int)d->count, (int)d->count, d->root);
}

static weft_code decoder_create(const weft_component_images *images, const float *factor, int count, float exponent,
                                decoder *d, weft_error *error)
{
    size_t taken = (size_t)(images->image_count < MOST_IMAGES ? images->image_count : MOST_IMAGES);
    *d = (decoder){.exponent = exponent, .count = (size_t)count, .length = 3 * taken};
    d->factor = calloc(d->count * d->length, sizeof *d->factor);
    d->root = malloc(d->count * d->count * sizeof *d->root);
    if (!d->factor || !d->root) {
        decoder_free(d);
        return weft_fail_memory(error, "levels of components", d->count * d->length * sizeof *d->factor);
    }
    fill_decoder(images, factor, d);
    if (!factor_products(d)) {
        free(d->root);
        d->root = NULL;
    }
    return WEFT_OK;
}

WEFT_HOT static void sum_components(const decoder *d, const float *coefficient, float *sum)
{
    memset(sum, 0, d->length * sizeof *sum);
    for (size_t k = 0; k < d->count; k++) {
        const float *factor = d->factor + k * d->length;
        float c = coefficient[k];
        for (size_t s = 0; s < d->length; s++)
            sum[s] += c * factor[s];
    }
}

WEFT_HOT static void add_decoded(const decoder *d, float weight, const float *coded, float *mean)
{
    for (size_t s = 0; s < d->length; s++)
        mean[s] += weight * weft_power(coded[s], d->exponent);
}

WEFT_HOT static float dot(const float *a, const float *b, size_t length)
{
    float sum = 0;
    for (size_t s = 0; s < length; s++)
        sum += a[s] * b[s];
    return sum;
}

/* The coefficients of what `mean` is in linear light. */
static void project_mean(const decoder *d, float *mean, float *coefficient)
{
    double x[WEFT_COMPONENTS_MAX];
    for (size_t s = 0; s < d->length; s++)
        mean[s] = weft_coded(d->exponent, mean[s]);
    for (size_t k = 0; k < d->count; k++)
        x[k] = (double)dot(d->factor + k * d->length, mean, d->length);
    weft_cholesky_solve((int)d->count, (int)d->count, d->root, x);
    for (size_t k = 0; k < d->count; k++)
        coefficient[k] = (float)x[k];
}

/* ---- The next level ---- */

/* The mean of up to four texels, by what they cover, goes to texel (x, y) of the next level. */
static void merge(pyramid *p, int level, int width0, int height0, int x, int y, int next_width)
{
    size_t to = (size_t)y * (size_t)next_width + (size_t)x;
    float sum[WEFT_COMPONENTS_MAX] = {0}, dark[3] = {0}, most = 0, total = 0;
    for (int j = 2 * y; j < 2 * y + 2 && j < p->height; j++)
        for (int i = 2 * x; i < 2 * x + 2 && i < p->width; i++) {
            size_t from = (size_t)j * (size_t)p->width + (size_t)i;
            float weight = (float)covered(i, level, width0) * (float)covered(j, level, height0);
            for (size_t k = 0; k < p->component_count; k++)
                sum[k] += weight * p->coefficient[from * p->component_count + k];
            for (size_t c = 0; c < 3; c++)
                dark[c] += weight * p->floor[3 * from + c];
            most = fmaxf(most, p->brightest[from]);
            total += weight;
        }
    for (size_t k = 0; k < p->component_count; k++)
        p->coefficient[to * p->component_count + k] = sum[k] / total;
    for (size_t c = 0; c < 3; c++)
        p->floor[3 * to + c] = dark[c] / total;
    p->brightest[to] = most;
}

/* A texel of the next level lies before those that it is made of, so that nothing is overwritten too early. */
static void merge_all(pyramid *p, int level, int width0, int height0)
{
    int width = (p->width + 1) / 2, height = (p->height + 1) / 2;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            merge(p, level, width0, height0, x, y, width);
    p->width = width;
    p->height = height;
}

/* The coefficients of texel (x, y) of the next level, of the present ones; `room` has two vectors of the decoder. */
static void decode_texel(const pyramid *p, const decoder *d, int level, int width0, int height0, int x, int y,
                         float *room, float *coefficient)
{
    float *mean = room, *coded = room + d->length, total = 0;
    memset(mean, 0, d->length * sizeof *mean);
    for (int j = 2 * y; j < 2 * y + 2 && j < p->height; j++)
        for (int i = 2 * x; i < 2 * x + 2 && i < p->width; i++)
            total += (float)covered(i, level, width0) * (float)covered(j, level, height0);
    for (int j = 2 * y; j < 2 * y + 2 && j < p->height; j++)
        for (int i = 2 * x; i < 2 * x + 2 && i < p->width; i++) {
            float weight = (float)covered(i, level, width0) * (float)covered(j, level, height0) / total;
            sum_components(d, p->coefficient + ((size_t)j * (size_t)p->width + (size_t)i) * d->count, coded);
            add_decoded(d, weight, coded, mean);
        }
    project_mean(d, mean, coefficient);
}

/* coefficient [texel of the next level][count]. */
static weft_code decode_level(const pyramid *p, const decoder *d, int level, int width0, int height0,
                              float *coefficient, weft_error *error)
{
    int width = (p->width + 1) / 2, height = (p->height + 1) / 2, failures = 0;
#pragma omp parallel for schedule(dynamic) reduction(+ : failures)
    for (int y = 0; y < height; y++) {
        float *room = malloc(2 * d->length * sizeof *room);
        failures += !room;
        for (int x = 0; x < width && room; x++)
            decode_texel(p, d, level, width0, height0, x, y, room,
                         coefficient + ((size_t)y * (size_t)width + (size_t)x) * d->count);
        free(room);
    }
    return failures > 0 ? weft_fail_memory(error, "levels of components", 2 * d->length * sizeof *coefficient)
                        : WEFT_OK;
}

/* Coded components where `d` has any products. */
static weft_code next_level(pyramid *p, const decoder *d, int level, int width0, int height0, weft_error *error)
{
    if (!d->root) {
        merge_all(p, level, width0, height0);
        return WEFT_OK;
    }
    size_t bytes = (size_t)((p->width + 1) / 2) * (size_t)((p->height + 1) / 2) * d->count * sizeof(float);
    float *coefficient = malloc(bytes);
    if (!coefficient)
        return weft_fail_memory(error, "levels of components", bytes);
    weft_code code = decode_level(p, d, level, width0, height0, coefficient, error);
    merge_all(p, level, width0, height0);
    memcpy(p->coefficient, coefficient, bytes);
    free(coefficient);
    return code;
}

static weft_code fill_all(pyramid *p, const decoder *d, const float *step, bool has_finer, int width0, int height0,
                          weft_components *components, weft_error *error)
{
    for (int k = 0; k < components->level_count; k++) {
        if (k > 0)
            WEFT_TRY(next_level(p, d, k - 1, width0, height0, error));
        write_codes(p, step, has_finer, &components->level[k]);
        write_ceilings(p, components->level[k].ceiling);
        write_floors(p, components->level[k].floor);
    }
    return WEFT_OK;
}

weft_code weft_components_fill_levels(weft_projection *projection, const weft_component_images *images,
                                      const float *factor, weft_components *components, weft_error *error)
{
    float step[WEFT_COMPONENTS_MAX] = {0};
    pyramid p = {.width = projection->width,
                 .height = projection->height,
                 .component_count = (size_t)projection->component_count,
                 .coefficient = projection->coefficient,
                 .brightest = projection->brightest,
                 .floor = projection->floor};
    bool has_finer = components->component_count > projection->component_count;
    decoder d = {0};
    if (components->exponent != 1)
        WEFT_TRY(decoder_create(images, factor, projection->component_count, components->exponent, &d, error));
    find_steps(&p, step);
    weft_code code = fill_all(&p, &d, step, has_finer, projection->width, projection->height, components, error);
    decoder_free(&d);
    for (int k = 0; k < projection->component_count; k++)
        components->scale[k] *= step[k];
    for (int k = projection->component_count; k < components->component_count; k++)
        components->scale[k] *= step[k - projection->component_count] / FINER;
    return code;
}
