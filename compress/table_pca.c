#include "compress/table_pca.h"

#include "reflectance/lafortune.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLED_TEXELS = 8192, SWEEPS = 6 };

/* The tables T or S of one level, as rows of codes: one for each channel of each texel. */
typedef struct rows {
    const weft_material *material;
    const weft_material_level *level;
    const uint8_t *table;       /* [direction][texel][4] */
    const weft_vec3 *direction; /* [direction_count], of the view or light */
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

/* Integral over the hemisphere of (rho + sum_i (c_i . w)^N_i)^2, products of different lobes left out; w is light or
 * view, since f is reciprocal. A cap of cosine powers has 2 pi / (N + 1). */
static double model_energy(double rho, const weft_lobe *lobe, int lobe_count, weft_vec3 direction)
{
    double sum = 2 * WEFT_PI * rho * rho;
    for (int i = 0; i < lobe_count; i++) {
        weft_vec3 c = {lobe[i].cx * direction.x, lobe[i].cy * direction.y, lobe[i].cz * direction.z};
        double n = (double)lobe[i].n, peak = (double)weft_lobe_power(weft_length(c), lobe[i].n);
        sum += 2 * WEFT_PI * peak * (2 * rho / (n + 1) + peak / (2 * n + 1));
    }
    return sum;
}

static void get_model(const rows *r, size_t row, double *rho, weft_lobe lobe[WEFT_MATERIAL_MAX_LOBES])
{
    size_t texel = row / 3, channel = row % 3;
    *rho = (double)weft_float_of_half(r->level->diffuse[4 * texel + channel]);
    for (size_t i = 0; i < (size_t)r->material->lobe_count; i++) {
        const weft_half *code = r->level->lobe + 4 * ((3 * i + channel) * r->texel_count + texel);
        lobe[i] = (weft_lobe){weft_float_of_half(code[0]), weft_float_of_half(code[1]), weft_float_of_half(code[2]),
                              weft_float_of_half(code[3])};
    }
}

/* What the square of an error of a code does to f: T = (x / 255)^2 errs by 2 x / 255^2, and f by <f|f> times that. */
static void get_weights(const rows *r, size_t row, const double *code, double *weight)
{
    double rho;
    weft_lobe lobe[WEFT_MATERIAL_MAX_LOBES];
    weft_frame frame = weft_frame_decode(r->level->frame + 3 * (row / 3));
    get_model(r, row, &rho, lobe);
    for (int d = 0; d < r->direction_count; d++) {
        weft_vec3 local = weft_frame_local(&frame, r->direction[d]);
        weight[d] = model_energy(rho, lobe, r->material->lobe_count, local) * (code[d] * code[d] + 1) + 1e-12;
    }
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
    size_t stride = r->texel_count / SAMPLED_TEXELS + 1, texels = (r->texel_count + stride - 1) / stride;
    size_t n = (size_t)r->direction_count, terms = 1 + (size_t)components;
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

/* Components so long that the coefficients of the rows that were learnt from reach 127; then the integers take the place
 * of what was learnt. */
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

static weft_code reduce(const weft_material *material, const weft_material_level *level, bool of_lights, int components,
                        weft_table_basis **basis, weft_error *error)
{
    uint8_t *table = of_lights ? level->light_table : level->table;
    const rows r = {.material = material,
                    .level = level,
                    .table = table,
                    .direction = of_lights ? material->light : material->view,
                    .direction_count = of_lights ? material->light_count : material->view_count,
                    .texel_count = (size_t)level->width * (size_t)level->height};
    if (!table || r.direction_count == 0)
        return WEFT_OK;
    WEFT_TRY(weft_table_basis_create(components < r.direction_count ? components : r.direction_count, r.direction_count,
                                     r.texel_count, basis, error));
    WEFT_TRY(fill_basis(&r, *basis, error));
    weft_table_basis_decode(*basis, table);
    return WEFT_OK;
}

weft_code weft_material_reduce_tables(weft_material *material, int component_count, weft_error *error)
{
    weft_code code = WEFT_OK;
    for (int k = 0; k < material->level_count && code == WEFT_OK; k++) {
        weft_material_level *level = &material->level[k];
        code = reduce(material, level, false, component_count, &level->table_basis, error);
        if (code == WEFT_OK)
            code = reduce(material, level, true, component_count, &level->light_table_basis, error);
    }
    material->has_table_bases = code == WEFT_OK && material->view_count + material->light_count > 0;
    material->has_opacity = weft_material_has_holes(material);
    return code;
}
