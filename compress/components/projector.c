#include "base/numeric/cholesky.h"
#include "compress/components/dots.h"
#include "compress/components/factorisation.h"
#include "compress/components/model.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Of the largest diagonal element: keeps factors that are 0, or alike, apart. */
static const double least_ridge = 1e-7;

void weft_projector_free(weft_projector *projector)
{
    free(projector->gram);
    free(projector->root);
    free(projector->ridge);
    *projector = (weft_projector){0};
}

static void point_at(const weft_projector *projector, const float **row)
{
    for (size_t k = 0; k < (size_t)projector->count; k++)
        row[k] = projector->factor + k * projector->length;
}

static void fill_gram(weft_projector *projector)
{
    int count = projector->count;
    const float *row[WEFT_COMPONENTS_MAX];
    float product[WEFT_COMPONENTS_MAX];
    point_at(projector, row);
    for (int i = 0; i < count; i++) {
        weft_dots(row + i, 1, row, count, projector->length, product);
        for (int j = 0; j < count; j++)
            projector->gram[i * count + j] = (double)product[j];
    }
}

static void fill_ridge(const weft_factorisation *components, weft_projector *projector)
{
    double most = 0;
    for (int k = 0; k < projector->count; k++)
        most = fmax(most, projector->gram[k * projector->count + k]);
    for (int k = 0; k < projector->count; k++) {
        double variance = components->variance[k];
        projector->ridge[k] = variance > 0 ? components->noise / variance : most;
        projector->ridge[k] = fmin(projector->ridge[k], most) + least_ridge * most + 1e-30;
    }
}

/* Replaces gram by Cholesky's factor of gram + ridge; false where rounding has left nothing of it. */
static bool factor(const weft_projector *projector, double *gram)
{
    for (int k = 0; k < projector->count; k++)
        gram[k * projector->count + k] += projector->ridge[k];
    return weft_cholesky_factor(projector->count, projector->count, gram);
}

weft_code weft_projector_create(const weft_factorisation *components, const float *factors, int image_count,
                                weft_projector *projector, weft_error *error)
{
    size_t count = (size_t)components->count;
    *projector = (weft_projector){.count = components->count,
                                  .image_count = image_count,
                                  .length = components->length,
                                  .factor = factors,
                                  .gram = malloc(count * count * sizeof *projector->gram),
                                  .root = malloc(count * count * sizeof *projector->root),
                                  .ridge = malloc(count * sizeof *projector->ridge)};
    if (!projector->gram || !projector->root || !projector->ridge) {
        weft_projector_free(projector);
        return weft_fail_memory(error, "projection", count * count * sizeof(double));
    }
    fill_gram(projector);
    fill_ridge(components, projector);
    memcpy(projector->root, projector->gram, count * count * sizeof *projector->root);
    if (factor(projector, projector->root))
        return WEFT_OK;
    weft_projector_free(projector);
    return weft_fail(error, WEFT_BAD_INPUT, "samples that are no numbers have no components");
}

/* ---- Texels that lack samples, or have clipped ones ---- */

enum { MOST_ROUNDS = 8, ALL_CHANNELS = 7 };

/* Room for one texel. */
typedef struct solving {
    double *gram;     /* [count][count] */
    uint8_t *dropped; /* [image_count] channels that do not count, as bits */
} solving;

/* Takes what the factors are at some channels of an image out of the lower triangle of the Gram matrix. */
static void remove_samples(const weft_projector *projector, size_t image, unsigned channels, double *gram)
{
    size_t count = (size_t)projector->count;
    for (size_t c = 0; c < 3; c++) {
        const float *at = projector->factor + 3 * image + c;
        for (size_t i = 0; i < count && (channels >> c & 1); i++) {
            double own = (double)at[i * projector->length];
            for (size_t j = 0; j <= i; j++)
                gram[i * count + j] -= own * (double)at[j * projector->length];
        }
    }
}

/* And out of the products of the factors with the samples. */
static void remove_products(const weft_projector *projector, const float *vector, size_t image, unsigned channels,
                            double *x)
{
    for (size_t c = 0; c < 3; c++)
        for (size_t k = 0; k < (size_t)projector->count && (channels >> c & 1); k++)
            x[k] -= (double)vector[3 * image + c] * (double)projector->factor[k * projector->length + 3 * image + c];
}

/* Coefficients of what is not dropped, from the products of the factors with all samples. */
static void solve_rest(const weft_projector *projector, const float *vector, const solving *own, const float *product,
                       double *x)
{
    size_t count = (size_t)projector->count;
    memcpy(own->gram, projector->gram, count * count * sizeof *own->gram);
    for (size_t k = 0; k < count; k++)
        x[k] = (double)product[k];
    for (size_t image = 0; image < (size_t)projector->image_count; image++) {
        if (!own->dropped[image])
            continue;
        remove_samples(projector, image, own->dropped[image], own->gram);
        remove_products(projector, vector, image, own->dropped[image], x);
    }
    const double *root = factor(projector, own->gram) ? own->gram : projector->root;
    weft_cholesky_solve(projector->count, projector->count, root, x);
}

/* The clipped channels of an image that are said to be brighter than they look: their samples say nothing then. */
static unsigned brighter_channels(const weft_projector *projector, const float *vector, size_t image, uint8_t known,
                                  const double *x)
{
    unsigned brighter = 0;
    for (size_t c = 0; c < 3; c++) {
        double value = 0;
        for (size_t k = 0; k < (size_t)projector->count && (known & WEFT_SAMPLE_CLIPPED << c); k++)
            value += x[k] * (double)projector->factor[k * projector->length + 3 * image + c];
        brighter |= value > (double)vector[3 * image + c] && (known & WEFT_SAMPLE_CLIPPED << c) ? 1U << c : 0;
    }
    return brighter;
}

static bool drop_brighter(const weft_projector *projector, const float *vector, const uint8_t *known,
                          const solving *own, const double *x)
{
    bool changed = false;
    for (size_t image = 0; image < (size_t)projector->image_count; image++) {
        if (known[image] == 0 || known[image] == WEFT_SAMPLE_VALID)
            continue;
        uint8_t brighter = (uint8_t)brighter_channels(projector, vector, image, known[image], x);
        changed = changed || brighter != own->dropped[image];
        own->dropped[image] = brighter;
    }
    return changed;
}

/* The least of squares of which some count on one side only, by Newton's method: they all count at first. */
static void solve_partly(const weft_projector *projector, const float *vector, const uint8_t *known, const solving *own,
                         const float *product, double *x)
{
    for (size_t image = 0; image < (size_t)projector->image_count; image++)
        own->dropped[image] = known[image] ? 0 : ALL_CHANNELS;
    solve_rest(projector, vector, own, product, x);
    for (int round = 1; round < MOST_ROUNDS && drop_brighter(projector, vector, known, own, x); round++)
        solve_rest(projector, vector, own, product, x);
}

static bool is_whole(const uint8_t *known, int image_count)
{
    bool is = true;
    for (int i = 0; i < image_count; i++)
        is = is && known[i] == WEFT_SAMPLE_VALID;
    return is;
}

static void solve_texels(const weft_projector *projector, const float *const *vector, const uint8_t *const *known,
                         int texel_count, const solving *room, float *coefficient)
{
    int count = projector->count;
    double x[WEFT_COMPONENTS_MAX];
    for (int texel = 0; texel < texel_count; texel++) {
        float *own = coefficient + (size_t)texel * (size_t)count;
        for (int k = 0; k < count; k++)
            x[k] = (double)own[k];
        if (is_whole(known[texel], projector->image_count))
            weft_cholesky_solve(count, count, projector->root, x);
        else
            solve_partly(projector, vector[texel], known[texel], room, own, x);
        for (int k = 0; k < count; k++)
            own[k] = (float)x[k];
    }
}

weft_code weft_projector_solve(const weft_projector *projector, const float *const *vector, const uint8_t *const *known,
                               int texel_count, float *coefficient, weft_error *error)
{
    size_t count = (size_t)projector->count, images = (size_t)projector->image_count;
    const float *row[WEFT_COMPONENTS_MAX];
    solving room = {malloc(count * count * sizeof *room.gram), malloc(images)};
    weft_code code = room.gram && room.dropped
                         ? WEFT_OK
                         : weft_fail_memory(error, "projection", count * count * sizeof *room.gram + images);
    if (code == WEFT_OK) {
        point_at(projector, row);
        weft_dots(vector, texel_count, row, projector->count, projector->length, coefficient);
        solve_texels(projector, vector, known, texel_count, &room, coefficient);
    }
    free(room.gram);
    free(room.dropped);
    return code;
}

/* ---- Texels whose directions are their own ---- */

enum { ALIGNMENT = 64 };

weft_code weft_near_projector_create(const weft_dataset_layout *layout, const weft_factorisation *components,
                                     const weft_component_maps *maps, const weft_component_images *images,
                                     weft_near_projector *projector, weft_error *error)
{
    size_t bytes = (size_t)components->count * images->length * sizeof(float);
    *projector = (weft_near_projector){.layout = layout, .maps = maps, .prior = *components};
    projector->prior.length = images->length;
    WEFT_TRY(weft_component_images_copy(images, &projector->images, error));
    projector->factor = aligned_alloc(ALIGNMENT, bytes);
    if (projector->factor)
        return WEFT_OK;
    weft_near_projector_free(projector);
    return weft_fail_memory(error, "factors of components", bytes);
}

void weft_near_projector_free(weft_near_projector *projector)
{
    weft_component_images_free(&projector->images);
    free(projector->factor);
    *projector = (weft_near_projector){0};
}

void weft_near_projector_move(weft_near_projector *projector, int x, int y)
{
    weft_component_images_look_from(projector->layout, x, y, &projector->images);
}

weft_code weft_near_projector_solve(weft_near_projector *projector, const float *vector, const uint8_t *known,
                                    float *coefficient, weft_error *error)
{
    weft_projector own;
    weft_component_model_factors_alone(projector->maps, &projector->images, projector->factor);
    WEFT_TRY(weft_projector_create(&projector->prior, projector->factor, projector->images.image_count, &own, error));
    weft_code code = weft_projector_solve(&own, &vector, &known, 1, coefficient, error);
    weft_projector_free(&own);
    return code;
}
