#include "compress/hold_out/certify.h"

#include "base/integers.h"
#include "base/numeric/conformal.h"
#include "base/numeric/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The error that a value has at least, in units of the mean, and the least factor of a ring: where all residuals are 0,
 * as in black places, an error later on should not be infinitely many times as large. */
static const double least_spread = 0.01, least_factor = 0.05;

static const double spread_share = 0.9;

/* Between which quantiles of the predictions each knot lies: more of them where values are large, and few. */
static const double knot_ends[WEFT_CERTIFICATE_KNOTS + 1] = {0, 0.1, 0.25, 0.4, 0.6, 0.8, 0.92, 0.98, 1};

enum { ROUNDS = 4 };

/* ---- The scale ---- */

static int compare_predictions(const void *left, const void *right)
{
    float a = ((const weft_residual *)left)->prediction, b = ((const weft_residual *)right)->prediction;
    return (a > b) - (a < b);
}

static double mean_prediction(const weft_residuals *held)
{
    double sum = 0;
    for (size_t i = 0; i < held->count[0]; i++)
        sum += fabs((double)held->value[0][i].prediction);
    return held->count[0] > 0 ? sum / (double)held->count[0] : 0;
}

/* The mean prediction and the quantile of the errors of one knot's share of the residuals, which are sorted. */
static void find_knot(const weft_residual *residual, size_t count, int knot, float *scratch, weft_certificate *c)
{
    size_t first = (size_t)(knot_ends[knot] * (double)count), end = (size_t)(knot_ends[knot + 1] * (double)count);
    double sum = 0;
    for (size_t i = first; i < end; i++) {
        sum += fmax(0, (double)residual[i].prediction);
        scratch[i - first] = residual[i].error;
    }
    double error = (double)weft_quantile_of_floats(scratch, end - first, spread_share);
    c->value[knot] = end > first ? sum / (double)(end - first) / c->mean : 0;
    c->spread[knot] = fmax(least_spread, error / c->mean);
}

static void find_spread(const weft_residuals *held, float *scratch, weft_certificate *c)
{
    qsort(held->value[0], held->count[0], sizeof *held->value[0], compare_predictions);
    for (int knot = 0; knot < WEFT_CERTIFICATE_KNOTS; knot++)
        find_knot(held->value[0], held->count[0], knot, scratch, c);
}

static double score_of(const weft_certificate *c, const weft_residual *residual, double error)
{
    return error / weft_certificate_scale_of_rings(c, (double)residual->prediction, residual->light, residual->view);
}

typedef enum ring_kind { OF_VIEW, OF_LIGHT } ring_kind;

static int ring_of(const weft_residual *residual, ring_kind kind)
{
    return kind == OF_VIEW ? residual->view : residual->light;
}

/* Rings without an image have the factor of the nearest one with some; of two the outer one. */
static void fill_rings(const int *images, double *factor)
{
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        for (int away = 1; images[ring] == 0 && away < WEFT_RING_COUNT; away++) {
            int outer = ring + away, inner = ring - away;
            bool has_outer = outer < WEFT_RING_COUNT && images[outer] > 0, has_inner = inner >= 0 && images[inner] > 0;
            if (!has_outer && !has_inner)
                continue;
            factor[ring] = factor[has_outer ? outer : inner];
            break;
        }
    }
}

/* Factors of the rings such that each has the same quantile of scores. */
static void find_factors(const weft_residuals *held, ring_kind kind, double probability, float *scratch,
                         weft_certificate *c)
{
    double *factor = kind == OF_VIEW ? c->view : c->light;
    const int *images = kind == OF_VIEW ? c->view_images : c->light_images;
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        size_t count = 0;
        for (size_t i = 0; i < held->count[0]; i++) {
            const weft_residual *residual = &held->value[0][i];
            if (ring_of(residual, kind) == ring)
                scratch[count++] = (float)score_of(c, residual, (double)residual->error);
        }
        factor[ring] = fmax(least_factor, factor[ring] * (double)weft_quantile_of_floats(scratch, count, probability));
    }
    fill_rings(images, factor);
}

/* ---- Images ---- */

/* Counts the images of each ring; one that lies in several, under near lights, counts in each. */
static weft_code count_images(const weft_residuals *held, weft_certificate *c, weft_error *error)
{
    uint32_t largest = 0;
    for (size_t i = 0; i < held->count[0]; i++)
        largest = held->value[0][i].image > largest ? held->value[0][i].image : largest;
    uint32_t *seen = calloc((size_t)largest + 1, sizeof *seen);
    if (!seen)
        return weft_fail_memory(error, "images", ((size_t)largest + 1) * sizeof *seen);
    for (size_t i = 0; i < held->count[0]; i++) {
        const weft_residual *residual = &held->value[0][i];
        uint32_t view = 1u << residual->view, light = 1u << (residual->light + 8);
        c->image_count += seen[residual->image] == 0;
        c->view_images[residual->view] += !(seen[residual->image] & view);
        c->light_images[residual->light] += !(seen[residual->image] & light);
        seen[residual->image] |= view | light;
    }
    free(seen);
    return WEFT_OK;
}

/* ---- Quantiles ---- */

static double pixel_quantile(const weft_grouped_score *score, size_t count, double probability)
{
    size_t rank = weft_conformal_rank(count, probability);
    return (double)score[rank > 0 ? rank - 1 : count - 1].score;
}

/* Over images where they suffice, else over pixels; the scores are sorted by the first. */
static weft_code find_quantile(const weft_residuals *held, int level, weft_certificate *c, double *quantile,
                               weft_error *error)
{
    size_t count = held->count[level], images;
    weft_grouped_score *score = malloc((count + 1) * sizeof *score);
    if (!score)
        return weft_fail_memory(error, "scores", count * sizeof *score);
    for (size_t i = 0; i < count; i++) {
        const weft_residual *residual = &held->value[level][i];
        score[i] = (weft_grouped_score){(float)score_of(c, residual, (double)residual->error), residual->image};
    }
    weft_code code = weft_conformal_quantile_of_groups(score, count, c->probability, quantile, &images, error);
    if (code == WEFT_OK && isinf(*quantile)) {
        c->over_images = false;
        *quantile = pixel_quantile(score, count, c->probability);
    }
    free(score);
    return code;
}

/* ---- Parts ---- */

static const double one_of_rounding = 0.28867513459481287; /* 1 / sqrt(12) */

typedef double error_of(const weft_residual *residual);

static double error_of_sample(const weft_residual *residual)
{
    return (double)residual->error;
}

static double error_of_storage(const weft_residual *residual)
{
    return one_of_rounding * (double)residual->moved;
}

/* The quantile of other errors by ring of the view, as shares of the half width. */
static void find_shares(const weft_residuals *residuals, int level, error_of *part, float *scratch,
                        const weft_certificate *c, double quantile, double share[WEFT_RING_COUNT])
{
    int images[WEFT_RING_COUNT];
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        size_t count = 0;
        for (size_t i = 0; i < residuals->count[level]; i++) {
            const weft_residual *residual = &residuals->value[level][i];
            if (residual->view == ring)
                scratch[count++] = (float)(score_of(c, residual, part(residual)) / quantile);
        }
        images[ring] = count > 0;
        share[ring] = (double)weft_quantile_of_floats(scratch, count, c->probability);
    }
    fill_rings(images, share);
}

/* ---- Levels ---- */

static weft_code certify_level(const weft_residuals *held, const weft_residuals *fitted, int level, float *scratch,
                               weft_certificate *c, weft_certificate_level *result, weft_error *error)
{
    WEFT_TRY(find_quantile(held, level, c, &result->quantile, error));
    double quantile = fmax(result->quantile, 1e-3);
    if (level < fitted->level_count)
        find_shares(fitted, level, error_of_sample, scratch, c, quantile, result->fitted);
    find_shares(held, level, error_of_storage, scratch, c, quantile, result->storage);
    return WEFT_OK;
}

/* Which levels of a subset a material's are taken from. */
typedef struct level_source {
    int beside; /* up to this one they are of texels that lie beside each other */
    int apart;  /* later ones of texels so many levels further from each other */
    int last;
} level_source;

static level_source source_of_levels(const weft_residuals *held, double spacing, int neighbours)
{
    return (level_source){(int)floor(log2(neighbours)), (int)ceil(log2(fmax(1, spacing)) - 1e-6),
                          held->level_count - 1};
}

static int level_of_subset(const level_source *source, int level)
{
    int beside = weft_smaller(level, source->beside);
    return weft_smaller(weft_larger(beside, level - source->apart), source->last);
}

/* Levels of the material, of which several may be one of the subset. */
static weft_code certify_levels(const weft_residuals *held, const weft_residuals *fitted, const level_source *source,
                                float *scratch, weft_certificate *c, weft_error *error)
{
    c->level_count = weft_smaller(held->level_count + source->apart, WEFT_MATERIAL_MAX_LEVELS);
    c->measured_levels = source->apart == 0 ? c->level_count : weft_smaller(source->beside + 1, c->level_count);
    for (int k = 0; k < c->level_count; k++) {
        int of_subset = level_of_subset(source, k);
        if (k > 0 && of_subset == level_of_subset(source, k - 1))
            c->level[k] = c->level[k - 1];
        else
            WEFT_TRY(certify_level(held, fitted, of_subset, scratch, c, &c->level[k], error));
    }
    return WEFT_OK;
}

static weft_code certify(const weft_residuals *held, const weft_residuals *fitted, const level_source *source,
                         float *scratch, weft_certificate *c, weft_error *error)
{
    WEFT_TRY(count_images(held, c, error));
    find_spread(held, scratch, c);
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++)
        c->view[ring] = c->light[ring] = 1;
    for (int round = 0; round < ROUNDS; round++) {
        find_factors(held, OF_VIEW, c->probability, scratch, c);
        find_factors(held, OF_LIGHT, c->probability, scratch, c);
    }
    weft_certificate_round(c);
    WEFT_TRY(certify_levels(held, fitted, source, scratch, c, error));
    weft_certificate_round(c);
    return WEFT_OK;
}

static size_t largest_count(const weft_residuals *residuals)
{
    size_t largest = 0;
    for (int k = 0; k < residuals->level_count; k++)
        largest = residuals->count[k] > largest ? residuals->count[k] : largest;
    return largest;
}

weft_code weft_certify(const weft_residuals *held, const weft_residuals *fitted, double probability, double spacing,
                       int neighbours, weft_certificate *c, bool *found, weft_error *error)
{
    *c = (weft_certificate){
        .probability = probability, .over_images = true, .mean = (double)(float)mean_prediction(held)};
    *found = c->mean > 0;
    if (!*found)
        return WEFT_OK;
    size_t of_held = largest_count(held), of_fitted = largest_count(fitted);
    size_t most = of_held > of_fitted ? of_held : of_fitted;
    float *scratch = malloc((most + 1) * sizeof *scratch);
    if (!scratch)
        return weft_fail_memory(error, "residuals", most * sizeof *scratch);
    const level_source source = source_of_levels(held, spacing, neighbours);
    weft_code code = certify(held, fitted, &source, scratch, c, error);
    free(scratch);
    return code;
}
