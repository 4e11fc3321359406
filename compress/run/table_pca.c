#include "compress/run/table_pca.h"

#include "base/processor.h"
#include "compress/texel/pack.h"

#include <lapacke.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLED_CODES = 1 << 19, SWEEPS = 6 };

#define LEAST_WEIGHT 1e-3 /* of the mean over the directions */

/* The directions of the dataset, and what a thread needs to evaluate a model under them. */
typedef struct image_set {
    weft_bundle bundle;
    weft_samples samples; /* of cosines alone */
    int thread_count;
    weft_fit_workspace **workspace; /* [thread_count] */
} image_set;

/* The tables T or S of one level, as rows of codes: one for each channel of each texel. */
typedef struct rows {
    const weft_material *material;
    const weft_material_level *level;
    const image_set *images;
    bool of_lights;       /* S, not T */
    const uint8_t *table; /* [direction][texel][4] */
    const uint8_t *other; /* the one that is not reduced here, NULL where there is none */
    int direction_count;
    size_t texel_count;
} rows;

static size_t row_count(const rows *r)
{
    return 3 * r->texel_count;
}

static void get_codes(const rows *r, size_t row, double *code)
{
    for (size_t d = 0; d < (size_t)r->direction_count; d++)
        code[d] = r->table[4 * (d * r->texel_count + row / 3) + row % 3];
}

/* ---- Weights ---- */

static weft_fit get_model(const rows *r, size_t row)
{
    size_t texel = row / 3, channel = row % 3;
    weft_packed packed = {.diffuse = r->level->diffuse[4 * texel + channel]};
    weft_frame frame = weft_frame_decode(r->level->frame + 3 * texel);
    for (size_t i = 0; i < (size_t)r->material->lobe_count; i++)
        memcpy(packed.lobe[i], r->level->lobe + 4 * ((3 * i + channel) * r->texel_count + texel),
               sizeof packed.lobe[i]);
    return weft_unpack(&packed, r->material->lobe_count, &frame, 1);
}

/* What the other table makes of a sample. */
static double other_entry(const rows *r, size_t row, int direction)
{
    return r->other ? weft_table_of_code(r->other[4 * ((size_t)direction * r->texel_count + row / 3) + row % 3]) : 1;
}

/* What the square of an error of a code does to f: T = (x / 255)^2 errs by 2 x / 255^2, and f by <f|f> times that, over
 * the images of the dataset. Directions that few lights show keep a little. */
static void get_weights(const rows *r, size_t row, const double *code, double *weight)
{
    const weft_bundle *bundle = &r->images->bundle;
    const int *own = r->of_lights ? bundle->light_of : bundle->view_of,
              *across = r->of_lights || !r->other ? bundle->view_of : bundle->light_of;
    weft_fit fit = get_model(r, row);
    unsigned state = weft_denormals_off();
    const float *model =
        weft_fit_evaluate(bundle, &r->images->samples, r->images->workspace[omp_get_thread_num()], &fit);
    double sum = 0;
    memset(weight, 0, (size_t)r->direction_count * sizeof *weight);
    for (int i = 0; i < bundle->sample_count; i++) {
        double shown = (double)model[i] * other_entry(r, row, across[i]);
        weight[own[i]] += shown * shown;
    }
    weft_denormals_restore(state);
    for (int d = 0; d < r->direction_count; d++)
        sum += weight[d];
    for (int d = 0; d < r->direction_count; d++)
        weight[d] = (weight[d] + LEAST_WEIGHT * sum / r->direction_count) * (code[d] * code[d] + 1) + 1e-12;
}

/* ---- Weighted least squares ---- */

/* The small systems of one row or one direction. */
typedef struct normal_equations {
    int count;
    double matrix[(WEFT_BASIS_MAX_COMPONENTS + 1) * (WEFT_BASIS_MAX_COMPONENTS + 1)]; /* lower triangle */
    double right[WEFT_BASIS_MAX_COMPONENTS + 1];
} normal_equations;

static void clear_equations(normal_equations *e, int count)
{
    e->count = count;
    memset(e->matrix, 0, (size_t)count * (size_t)count * sizeof *e->matrix);
    memset(e->right, 0, (size_t)count * sizeof *e->right);
}

static void add_equation(normal_equations *e, const double *regressor, double value, double weight)
{
    for (int i = 0; i < e->count; i++) {
        double weighted = weight * regressor[i];
        e->right[i] += weighted * value;
        for (int j = 0; j <= i; j++)
            e->matrix[i * e->count + j] += weighted * regressor[j];
    }
}

/* A trace of ridge keeps directions that no regressor reaches at zero. */
static void solve_equations(normal_equations *e)
{
    double trace = 0;
    for (int i = 0; i < e->count; i++)
        trace += e->matrix[i * e->count + i];
    for (int i = 0; i < e->count; i++)
        e->matrix[i * e->count + i] += 1e-9 * trace + 1e-300;
    if (LAPACKE_dposv(LAPACK_ROW_MAJOR, 'L', e->count, 1, e->matrix, e->count, e->right, 1) != 0)
        memset(e->right, 0, (size_t)e->count * sizeof *e->right);
}

/* ---- Learning the components from some of the rows ---- */

typedef struct learning {
    int direction_count, component_count;
    size_t row_count;
    double *code, *weight; /* [row][direction] */
    double *regressor;     /* [row][1 + component]: 1, then coefficients */
    double *basis;         /* [direction][1 + component]: mean, then components */
} learning;

static weft_code learning_create(const rows *r, int components, learning *l, weft_error *error)
{
    size_t n = (size_t)r->direction_count, terms = 1 + (size_t)components;
    size_t stride = r->texel_count * 3 * n / SAMPLED_CODES + 1, texels = (r->texel_count + stride - 1) / stride;
    *l = (learning){.direction_count = r->direction_count, .component_count = components, .row_count = 3 * texels};
    l->code = malloc(l->row_count * n * sizeof *l->code);
    l->weight = malloc(l->row_count * n * sizeof *l->weight);
    l->regressor = calloc(l->row_count * terms, sizeof *l->regressor);
    l->basis = calloc(n * terms, sizeof *l->basis);
    if (!l->code || !l->weight || !l->regressor || !l->basis)
        return weft_fail_memory(error, "components of tables", 2 * l->row_count * n * sizeof *l->code);
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < l->row_count; i++) {
        size_t row = 3 * (i / 3 * stride) + i % 3;
        get_codes(r, row, l->code + i * n);
        get_weights(r, row, l->code + i * n, l->weight + i * n);
    }
    return WEFT_OK;
}

static void learning_free(learning *l)
{
    free(l->code);
    free(l->weight);
    free(l->regressor);
    free(l->basis);
}

static void start_mean(learning *l)
{
    size_t n = (size_t)l->direction_count, terms = 1 + (size_t)l->component_count;
    for (size_t d = 0; d < n; d++) {
        double sum = 0, total = 0;
        for (size_t row = 0; row < l->row_count; row++) {
            sum += l->weight[row * n + d] * l->code[row * n + d];
            total += l->weight[row * n + d];
        }
        l->basis[d * terms] = sum / total;
    }
}

/* Covariance with the mean weight of each row: the lower triangle, row-major. */
static void find_covariance(const learning *l, double *deviation, double *covariance)
{
    size_t n = (size_t)l->direction_count, terms = 1 + (size_t)l->component_count;
    memset(covariance, 0, n * n * sizeof *covariance);
    for (size_t row = 0; row < l->row_count; row++) {
        double weight = 0;
        for (size_t d = 0; d < n; d++) {
            weight += l->weight[row * n + d] / (double)n;
            deviation[d] = l->code[row * n + d] - l->basis[d * terms];
        }
        for (size_t d = 0; d < n; d++) {
            for (size_t e = 0; e <= d; e++)
                covariance[d * n + e] += weight * deviation[d] * deviation[e];
        }
    }
}

/* The eigenvectors with the largest eigenvalues. */
static weft_code start_components(learning *l, weft_error *error)
{
    int n = l->direction_count, k = l->component_count, terms = 1 + k;
    size_t cells = (size_t)n * (size_t)n;
    lapack_int found = 0, *support = malloc(2 * (size_t)n * sizeof *support);
    double *work = malloc((cells + (size_t)n * (size_t)k + 2 * (size_t)n) * sizeof *work);
    weft_code code = WEFT_OK;
    if (!work || !support) {
        code = weft_fail_memory(error, "components of tables", cells * sizeof *work);
    } else {
        double *covariance = work, *vector = covariance + cells, *value = vector + n * k, *deviation = value + n;
        find_covariance(l, deviation, covariance);
        if (LAPACKE_dsyevr(LAPACK_ROW_MAJOR, 'V', 'I', 'L', n, covariance, n, 0, 0, n - k + 1, n, 0, &found, value,
                           vector, k, support) != 0)
            code = weft_fail(error, WEFT_SYSTEM, "the components of the tables could not be found");
        for (int d = 0; d < n && code == WEFT_OK; d++) {
            for (int i = 0; i < found; i++)
                l->basis[d * terms + 1 + i] = vector[d * k + found - 1 - i];
        }
    }
    free(work);
    free(support);
    return code;
}

static void fit_row(const learning *l, const double *code, const double *weight, double *regressor)
{
    normal_equations e;
    int terms = 1 + l->component_count;
    clear_equations(&e, l->component_count);
    for (int d = 0; d < l->direction_count; d++) {
        const double *basis = l->basis + d * terms;
        add_equation(&e, basis + 1, code[d] - basis[0], weight[d]);
    }
    solve_equations(&e);
    regressor[0] = 1;
    memcpy(regressor + 1, e.right, (size_t)l->component_count * sizeof *regressor);
}

static void fit_direction(learning *l, int direction)
{
    normal_equations e;
    size_t n = (size_t)l->direction_count, terms = 1 + (size_t)l->component_count, d = (size_t)direction;
    clear_equations(&e, (int)terms);
    for (size_t row = 0; row < l->row_count; row++)
        add_equation(&e, l->regressor + row * terms, l->code[row * n + d], l->weight[row * n + d]);
    solve_equations(&e);
    memcpy(l->basis + d * terms, e.right, terms * sizeof *l->basis);
}

/* One sweep of alternating least squares. */
static void sweep(learning *l)
{
    size_t n = (size_t)l->direction_count, terms = 1 + (size_t)l->component_count;
#pragma omp parallel for schedule(static)
    for (size_t row = 0; row < l->row_count; row++)
        fit_row(l, l->code + row * n, l->weight + row * n, l->regressor + row * terms);
#pragma omp parallel for schedule(static)
    for (int d = 0; d < l->direction_count; d++)
        fit_direction(l, d);
}

static weft_code learn(learning *l, weft_error *error)
{
    start_mean(l);
    WEFT_TRY(start_components(l, error));
    for (int i = 0; i < SWEEPS; i++)
        sweep(l);
    return WEFT_OK;
}

/* ---- Integers ---- */

static int16_t limited(double value)
{
    return (int16_t)lrint(fmin(fmax(value, INT16_MIN), INT16_MAX));
}

/* Components so long that the coefficients of the rows that were learnt from reach 127; then the integers take the
 * place of what was learnt. */
static void round_components(learning *l, weft_table_basis *basis)
{
    size_t n = (size_t)l->direction_count, terms = 1 + (size_t)l->component_count;
    for (size_t k = 0; k < terms; k++) {
        double largest = 0;
        for (size_t row = 0; row < l->row_count; row++)
            largest = fmax(largest, fabs(l->regressor[row * terms + k]));
        double step = largest / WEFT_BASIS_LARGEST_COEFFICIENT;
        for (size_t d = 0; d < n; d++) {
            double *value = &l->basis[d * terms + k], unit = k > 0 ? WEFT_BASIS_COMPONENT_UNIT : WEFT_BASIS_MEAN_UNIT;
            int16_t rounded = limited((k > 0 ? step : 1) * *value * unit);
            *(k > 0 ? &basis->component[(k - 1) * n + d] : &basis->mean[d]) = rounded;
            *value = rounded / unit;
        }
    }
}

static void round_row(const rows *r, const learning *l, size_t row, double *work, weft_table_basis *basis)
{
    double *code = work, *weight = code + l->direction_count, *regressor = weight + l->direction_count;
    get_codes(r, row, code);
    get_weights(r, row, code, weight);
    fit_row(l, code, weight, regressor);
    for (size_t k = 0; k < (size_t)l->component_count; k++) {
        double limit = WEFT_BASIS_LARGEST_COEFFICIENT;
        basis->coefficient[(3 * k + row % 3) * r->texel_count + row / 3] =
            (int8_t)lrint(fmin(fmax(regressor[k + 1], -limit), limit));
    }
}

static weft_code round_rows(const rows *r, const learning *l, weft_table_basis *basis, weft_error *error)
{
    bool failed = false;
#pragma omp parallel reduction(|| : failed)
    {
        double *work = malloc((2 * (size_t)l->direction_count + 1 + (size_t)l->component_count) * sizeof *work);
        failed = !work;
#pragma omp for schedule(static)
        for (size_t row = 0; row < row_count(r); row++) {
            if (work)
                round_row(r, l, row, work, basis);
        }
        free(work);
    }
    return failed ? weft_fail_memory(error, "coefficients of tables", 0) : WEFT_OK;
}

/* ---- Levels ---- */

static weft_code fill_basis(const rows *r, weft_table_basis *basis, weft_error *error)
{
    learning l;
    weft_code code = learning_create(r, basis->component_count, &l, error);
    if (code == WEFT_OK)
        code = learn(&l, error);
    if (code == WEFT_OK) {
        round_components(&l, basis);
        code = round_rows(r, &l, basis, error);
    }
    learning_free(&l);
    return code;
}

static weft_code reduce(const rows *like, bool of_lights, uint8_t *table, uint8_t *other, int components,
                        weft_table_basis **basis, weft_error *error)
{
    rows r = *like;
    r.of_lights = of_lights;
    r.table = table;
    r.other = other;
    r.direction_count = of_lights ? r.material->light_count : r.material->view_count;
    if (!table || r.direction_count == 0)
        return WEFT_OK;
    WEFT_TRY(weft_table_basis_create(components < r.direction_count ? components : r.direction_count, r.direction_count,
                                     r.texel_count, basis, error));
    WEFT_TRY(fill_basis(&r, *basis, error));
    weft_table_basis_decode(*basis, table);
    return WEFT_OK;
}

static weft_code reduce_level(const weft_material *material, weft_material_level *level, const image_set *images,
                              int components, weft_error *error)
{
    const rows like = {.material = material,
                       .level = level,
                       .images = images,
                       .texel_count = (size_t)level->width * (size_t)level->height};
    WEFT_TRY(reduce(&like, false, level->table, level->light_table, components, &level->table_basis, error));
    return reduce(&like, true, level->light_table, level->table, components, &level->light_table_basis, error);
}

/* ---- The whole ---- */

static weft_code create_images(const weft_dataset_layout *layout, const uint8_t *held_out, image_set *all,
                               weft_error *error)
{
    all->thread_count = omp_get_max_threads();
    WEFT_TRY(weft_bundle_create(layout, held_out, &all->bundle, error));
    WEFT_TRY(weft_samples_create(&all->bundle, &all->samples, error));
    for (int i = 0; i < all->bundle.sample_count; i++)
        all->samples.cosine[i] = all->bundle.image[i] >= 0 ? fmaxf(all->bundle.light[2][i], 0) : 0;
    all->workspace = calloc((size_t)all->thread_count, sizeof *all->workspace);
    if (!all->workspace)
        return weft_fail_memory(error, "components of tables", (size_t)all->thread_count * sizeof *all->workspace);
    for (int i = 0; i < all->thread_count; i++)
        WEFT_TRY(weft_fit_workspace_create(&all->bundle, &all->workspace[i], error));
    return WEFT_OK;
}

static void free_images(image_set *all)
{
    for (int i = 0; all->workspace && i < all->thread_count; i++)
        weft_fit_workspace_free(all->workspace[i]);
    free(all->workspace);
    weft_samples_free(&all->samples);
    weft_bundle_free(&all->bundle);
}

weft_code weft_material_reduce_tables(const weft_dataset_layout *layout, const uint8_t *held_out,
                                      weft_material *material, int component_count, weft_error *error)
{
    image_set all = {0};
    weft_code code = create_images(layout, held_out, &all, error);
    for (int k = 0; k < material->level_count && code == WEFT_OK; k++)
        code = reduce_level(material, &material->level[k], &all, component_count, error);
    free_images(&all);
    material->has_table_bases = code == WEFT_OK && material->view_count + material->light_count > 0;
    material->has_opacity = weft_material_has_holes(material);
    return code;
}
