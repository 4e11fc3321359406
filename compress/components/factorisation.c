#include "compress/components/factorisation.h"

#include "compress/components/dots.h"

#include <lapacke.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 5, ROWS = 16, ALIGNMENT = 64 };

void weft_factorisation_free(weft_factorisation *factorisation)
{
    free(factorisation->vector);
    free(factorisation->variance);
    *factorisation = (weft_factorisation){0};
}

/* ---- Eigenvectors ---- */

typedef struct eigen {
    int texels, wanted;
    const float **product_row; /* [texels] the samples */
    float *product;            /* [texels][texels] of the texels with each other */
    double *matrix;            /* the same */
    double trace;
    double *value;       /* [texels] the first `wanted`, from small to large */
    double *vector;      /* [texels][wanted] */
    lapack_int *support; /* what LAPACK wants besides */
} eigen;

static void eigen_free(eigen *e)
{
    free(e->product_row);
    free(e->product);
    free(e->matrix);
    free(e->value);
    free(e->vector);
    free(e->support);
}

static weft_code eigen_create(const weft_training *training, int count, eigen *e, weft_error *error)
{
    size_t texels = (size_t)training->texel_count;
    size_t wanted = (size_t)count < texels ? (size_t)count : texels;
    *e = (eigen){.texels = training->texel_count,
                 .wanted = (int)wanted,
                 .product_row = malloc(texels * sizeof *e->product_row),
                 .product = malloc(texels * texels * sizeof *e->product),
                 .matrix = malloc(texels * texels * sizeof *e->matrix),
                 .value = malloc(texels * sizeof *e->value),
                 .vector = malloc(texels * wanted * sizeof *e->vector),
                 .support = malloc(2 * wanted * sizeof *e->support)};
    if (!e->product_row || !e->product || !e->matrix || !e->value || !e->vector || !e->support)
        return weft_fail_memory(error, "products of texels", texels * texels * sizeof *e->matrix);
    for (size_t i = 0; i < texels; i++)
        e->product_row[i] = training->vector + i * training->length;
    return WEFT_OK;
}

/* The lower triangle of the products, in rows of whole tiles. */
static void multiply(eigen *e, size_t length)
{
    int texels = e->texels;
#pragma omp parallel for schedule(dynamic)
    for (int first = 0; first < texels; first += ROWS) {
        int rows = texels - first < ROWS ? texels - first : ROWS, columns = first + rows;
        float *product = e->product + (size_t)first * (size_t)texels;
        weft_dots(e->product_row + first, rows, e->product_row, columns, length, product);
        for (int i = 0; i < rows; i++)
            for (int j = 0; j < columns; j++)
                e->matrix[(size_t)(first + i) * (size_t)texels + (size_t)j] = (double)product[i * columns + j];
    }
}

static weft_code eigen_solve(eigen *e, const weft_training *training, weft_error *error)
{
    lapack_int texels = e->texels, found = 0;
    multiply(e, training->length);
    e->trace = 0;
    for (size_t i = 0; i < (size_t)texels; i++)
        e->trace += e->matrix[i * (size_t)texels + i];
    lapack_int first = texels - e->wanted + 1;
    if (LAPACKE_dsyevr(LAPACK_ROW_MAJOR, 'V', 'I', 'L', texels, e->matrix, texels, 0, 0, first, texels, 0, &found,
                       e->value, e->vector, e->wanted, e->support) != 0 ||
        found != e->wanted)
        return weft_fail(error, WEFT_SYSTEM, "the components of %d texels could not be computed", (int)texels);
    return WEFT_OK;
}

/* Component k: the texels weighted by the k-th eigenvector, of unit length; its sign makes its sum positive. */
static void combine(const eigen *e, const weft_training *training, int k, float *component)
{
    int column = e->wanted - 1 - k;
    double sum = 0;
    memset(component, 0, training->length * sizeof *component);
    if (column < 0 || !(e->value[column] > 1e-7 * e->value[e->wanted - 1]))
        return;
    for (int i = 0; i < e->texels; i++) {
        double part = e->vector[(size_t)i * (size_t)e->wanted + (size_t)column];
        float weight = (float)(part / sqrt(e->value[column]));
        const float *vector = e->product_row[i];
        for (size_t j = 0; j < training->length; j++)
            component[j] += weight * vector[j];
    }
    for (size_t j = 0; j < training->length; j++)
        sum += (double)component[j];
    for (size_t j = 0; j < training->length && sum < 0; j++)
        component[j] = -component[j];
}

static void read_components(const eigen *e, const weft_training *training, weft_factorisation *factorisation)
{
    double explained = 0, texels = (double)e->texels;
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k < factorisation->count; k++)
        combine(e, training, k, factorisation->vector + (size_t)k * factorisation->length);
    for (int k = 0; k < factorisation->count; k++) {
        double value = k < e->wanted ? fmax(e->value[e->wanted - 1 - k], 0) : 0;
        factorisation->variance[k] = value / texels;
        explained += value;
    }
    factorisation->noise = fmax(e->trace - explained, 1e-9 * e->trace) / (texels * 3 * (double)training->image_count);
}

/* ---- What is masked or clipped ---- */

/* A clipped channel is as bright as it looks or brighter. */
static void fill_texel(const weft_factorisation *factorisation, const float *coefficient, size_t images,
                       const uint8_t *known, const float *sample, float *filled)
{
    for (size_t i = 0; i < 3 * images; i++) {
        float value = 0;
        bool is_clipped = known[i / 3] & WEFT_SAMPLE_CLIPPED << i % 3;
        if (known[i / 3] && !is_clipped)
            continue;
        for (size_t k = 0; k < (size_t)factorisation->count; k++)
            value += coefficient[k] * factorisation->vector[k * factorisation->length + i];
        filled[i] = is_clipped ? fmaxf(value, sample[i]) : value;
    }
}

/* The coefficients follow from what is known. */
static weft_code fill_texels(const weft_training *training, const weft_factorisation *factorisation,
                             const weft_projector *projector, weft_training *filled, weft_error *error)
{
    weft_code result = WEFT_OK;
#pragma omp parallel for schedule(dynamic, 8)
    for (int texel = 0; texel < training->texel_count; texel++) {
        size_t first = (size_t)texel * training->length;
        const float *vector = training->vector + first;
        const uint8_t *known = training->known + (size_t)texel * training->image_count;
        float coefficient[WEFT_COMPONENTS_MAX];
        weft_error own = {0};
        weft_code code = weft_projector_solve(projector, &vector, &known, 1, coefficient, &own);
        if (code == WEFT_OK) {
            fill_texel(factorisation, coefficient, training->image_count, known, vector, filled->vector + first);
            continue;
        }
#pragma omp critical(weft_fill_texels)
        {
            result = code;
            *error = own;
        }
    }
    return result;
}

static weft_code fill_by_components(const weft_training *training, const weft_factorisation *factorisation,
                                    weft_training *filled, weft_error *error)
{
    weft_projector projector;
    WEFT_TRY(
        weft_projector_create(factorisation, factorisation->vector, (int)training->image_count, &projector, error));
    weft_code code = fill_texels(training, factorisation, &projector, filled, error);
    weft_projector_free(&projector);
    return code;
}

static weft_code find_once(const weft_training *whole, eigen *e, weft_factorisation *factorisation, weft_error *error)
{
    WEFT_TRY(eigen_solve(e, whole, error));
    read_components(e, whole, factorisation);
    return WEFT_OK;
}

static weft_code find(const weft_training *training, weft_factorisation *factorisation, weft_error *error)
{
    weft_training filled = {0};
    eigen e = {0};
    bool is_whole = weft_training_is_whole(training);
    weft_code code = is_whole ? WEFT_OK : weft_training_thin(training, training->texel_count, &filled, error);
    if (code == WEFT_OK && !is_whole)
        code = weft_training_fill_by_mean(&filled, error);
    const weft_training *whole = is_whole ? training : &filled;
    if (code == WEFT_OK)
        code = eigen_create(whole, factorisation->count, &e, error);
    if (code == WEFT_OK)
        code = find_once(whole, &e, factorisation, error);
    for (int round = 1; round < ROUNDS && !is_whole && code == WEFT_OK; round++) {
        code = fill_by_components(training, factorisation, &filled, error);
        if (code == WEFT_OK)
            code = find_once(&filled, &e, factorisation, error);
    }
    eigen_free(&e);
    weft_training_free(&filled);
    return code;
}

weft_code weft_factorisation_find(const weft_training *training, int count, weft_factorisation *factorisation,
                                  weft_error *error)
{
    *factorisation = (weft_factorisation){.count = count, .length = training->length};
    factorisation->vector = aligned_alloc(ALIGNMENT, (size_t)count * training->length * sizeof *factorisation->vector);
    factorisation->variance = malloc((size_t)count * sizeof *factorisation->variance);
    weft_code code = factorisation->vector && factorisation->variance
                         ? find(training, factorisation, error)
                         : weft_fail_memory(error, "components", (size_t)count * training->length * sizeof(float));
    if (code != WEFT_OK)
        weft_factorisation_free(factorisation);
    return code;
}
