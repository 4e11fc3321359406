#include "compress/sparse/sparse.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum {
    SLOPES = 5, /* in each direction, SLOPE_STEP apart, around 0 */
    EXPONENTS = WEFT_SPARSE_EXPONENTS,
    MAX_WORKER_BYTES = 256 << 20, /* of all threads together */
};

#define SLOPE_STEP 0.08f
#define DARK_SHARE 0.2f       /* of the mean sample: below it errors count absolutely, above it relatively */
#define AMPLITUDE_PRIOR 2e-4f /* an amplitude of 70 times rho is as unlikely as an error of the size of the sample */

typedef weft_sparse_shape candidate;

static candidate candidate_of_index(int index)
{
    int slope = index / EXPONENTS, column = slope % SLOPES - SLOPES / 2, row = slope / SLOPES - SLOPES / 2;
    return (candidate){.slope_x = SLOPE_STEP * (float)column,
                       .slope_y = SLOPE_STEP * (float)row,
                       .exponent = WEFT_SPARSE_FIRST_EXPONENT * exp2f(0.5f * (float)(index % EXPONENTS))};
}

static double penalty(const weft_sparse_setting *setting, candidate shape)
{
    double square = (double)(shape.slope_x * shape.slope_x + shape.slope_y * shape.slope_y);
    if ((double)shape.exponent > setting->largest_exponent * 1.01)
        return INFINITY;
    return square > 0 ? 1 + setting->stiffness * square : 1;
}

static float dot(const float *a, const float *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* l'.diag(-1, -1, 1).v', which is 2 (n.l)(n.v) - l.v. */
static float lobe_base(candidate shape, const float *light, const float *view)
{
    float scale = 1 / sqrtf(1 + shape.slope_x * shape.slope_x + shape.slope_y * shape.slope_y);
    float normal[3] = {shape.slope_x * scale, shape.slope_y * scale, scale};
    return 2 * dot(normal, light) * dot(normal, view) - dot(light, view);
}

static float lobe_value(candidate shape, const float *light, const float *view)
{
    float base = lobe_base(shape, light, view);
    return base > 0 ? light[2] * powf(base, shape.exponent) : 0;
}

float weft_sparse_value(const weft_sparse_texel *texel, const float light[3], const float view[3], int channel)
{
    candidate shape = {texel->slope_x, texel->slope_y, texel->exponent};
    return light[2] * texel->diffuse[channel] + texel->amplitude[channel] * lobe_value(shape, light, view);
}

/* Weighted products of the columns c (diffuse), g (lobe) and r (samples). */
typedef struct products {
    float cc, gg, cg, cr, gr, rr;
} products;

static void add_product(products *sums, float weight, float c, float g, float r)
{
    sums->cc += weight * c * c;
    sums->gg += weight * g * g;
    sums->cg += weight * c * g;
    sums->cr += weight * c * r;
    sums->gr += weight * g * r;
    sums->rr += weight * r * r;
}

/* Non-negative least squares for rho and A; returns the squared error. */
static float solve_products(const products *sums, float *diffuse, float *amplitude)
{
    float cc = sums->cc * 1.001f, gg = sums->gg * 1.001f + AMPLITUDE_PRIOR * sums->cc;
    float determinant = cc * gg - sums->cg * sums->cg;
    *diffuse = *amplitude = 0;
    if (!(cc > 0) || !(determinant > 0))
        return sums->rr;
    float d = (gg * sums->cr - sums->cg * sums->gr) / determinant;
    float a = (cc * sums->gr - sums->cg * sums->cr) / determinant;
    if (d < 0 || a < 0) {
        bool diffuse_alone = a < 0;
        d = diffuse_alone ? fmaxf(sums->cr / cc, 0) : 0;
        a = diffuse_alone ? 0 : fmaxf(sums->gr / gg, 0);
    }
    *diffuse = d;
    *amplitude = a;
    float error =
        sums->rr - 2 * (d * sums->cr + a * sums->gr) + d * d * sums->cc + a * a * sums->gg + 2 * d * a * sums->cg;
    return error > 0 ? error : 0;
}

/* ---- Memory ---- */

/* What a thread has seen: the errors of one slope, and the best shapes so far. */
typedef struct weft_sparse_worker {
    float *error;    /* [exponent][texel] of one slope, then pooled */
    float *pooled;   /* the same, half way */
    float *least;    /* [setting][texel] */
    int16_t *choice; /* [setting][texel] */
} weft_sparse_worker;

typedef weft_sparse_search search;

static bool create_worker(size_t texels, int setting_count, weft_sparse_worker *worker)
{
    size_t choices = texels * (size_t)setting_count;
    worker->error = malloc(EXPONENTS * texels * sizeof(float));
    worker->pooled = malloc(EXPONENTS * texels * sizeof(float));
    worker->least = malloc(choices * sizeof(float));
    worker->choice = malloc(choices * sizeof *worker->choice);
    return worker->error && worker->pooled && worker->least && worker->choice;
}

static int count_workers(size_t worker_bytes)
{
    int most = (int)(MAX_WORKER_BYTES / worker_bytes), threads = omp_get_max_threads();
    int count = threads < SLOPES * SLOPES ? threads : SLOPES * SLOPES;
    return most < 1 ? 1 : most < count ? most : count;
}

weft_code weft_sparse_search_create(weft_sparse_search *run, weft_error *error)
{
    size_t texels = weft_sparse_texel_count(run->field), samples = texels * (size_t)run->field->image_count;
    size_t choices = texels * (size_t)run->setting_count;
    size_t worker_bytes = (2 * EXPONENTS * texels + 2 * choices) * sizeof(float);
    run->worker_count = count_workers(worker_bytes);
    run->worker = calloc((size_t)run->worker_count, sizeof *run->worker);
    run->weight = malloc(samples * sizeof(float));
    run->grey = malloc(samples * sizeof(float));
    run->shape = malloc(choices * sizeof *run->shape);
    bool complete = run->worker && run->weight && run->grey && run->shape;
    for (int i = 0; complete && i < run->worker_count; i++)
        complete = create_worker(texels, run->setting_count, &run->worker[i]);
    if (complete)
        return WEFT_OK;
    return weft_fail_memory(error, "neighbourhood search", worker_bytes + (2 * samples + 3 * choices) * sizeof(float));
}

void weft_sparse_search_free(weft_sparse_search *run)
{
    for (int i = 0; run->worker && i < run->worker_count; i++) {
        free(run->worker[i].error);
        free(run->worker[i].pooled);
        free(run->worker[i].least);
        free(run->worker[i].choice);
    }
    free(run->worker);
    free(run->weight);
    free(run->grey);
    free(run->shape);
}

/* ---- Errors of all shapes ---- */

static void weigh_samples(search *run)
{
    const weft_sparse_field *field = run->field;
    size_t images = (size_t)field->image_count, samples = weft_sparse_texel_count(field) * images;
    double sum = 0, count = 0;
    for (size_t i = 0; i < samples; i++) {
        run->grey[i] = (field->value[3 * i] + field->value[3 * i + 1] + field->value[3 * i + 2]) / 3;
        run->weight[i] = field->weight[i] * field->image_weight[i % images];
        sum += (double)(run->weight[i] * run->grey[i]);
        count += (double)run->weight[i];
    }
    float dark = sum > 0 ? DARK_SHARE * (float)(sum / count) : 1;
    for (size_t i = 0; i < samples; i++) {
        float size = fmaxf(run->grey[i], 0) + dark;
        run->weight[i] = (int)(i % images) == run->left_out ? 0 : run->weight[i] / (size * size);
    }
}

/* l_z b^N of all exponents at once: every other one is the square of the one before it, an octave higher. */
static void lobe_values(candidate slope, const float *light, const float *view, float value[EXPONENTS])
{
    float base = lobe_base(slope, light, view);
    memset(value, 0, EXPONENTS * sizeof *value);
    if (!(base > 0))
        return;
    value[0] = base * base * base * base;
    value[1] = powf(base, WEFT_SPARSE_FIRST_EXPONENT * (float)M_SQRT2);
    for (int e = 2; e < EXPONENTS; e++)
        value[e] = value[e - 2] * value[e - 2];
    for (int e = 0; e < EXPONENTS; e++)
        value[e] *= light[2];
}

/* Squared errors of one texel for one slope and all exponents, into error[exponent][texel]. */
static void slope_errors(const search *run, size_t texel, candidate slope, float *error)
{
    size_t images = (size_t)run->field->image_count, texels = weft_sparse_texel_count(run->field);
    products common = {0};
    float gg[EXPONENTS] = {0}, cg[EXPONENTS] = {0}, gr[EXPONENTS] = {0};
    for (size_t i = texel * images; i < (texel + 1) * images; i++) {
        float weight = run->weight[i], c = run->field->light[3 * i + 2], g[EXPONENTS];
        if (!(weight > 0))
            continue;
        lobe_values(slope, run->field->light + 3 * i, run->field->view + 3 * i, g);
        add_product(&common, weight, c, 0, run->grey[i]);
        for (int e = 0; e < EXPONENTS; e++) {
            float weighted = weight * g[e];
            gg[e] += weighted * g[e];
            cg[e] += weighted * c;
            gr[e] += weighted * run->grey[i];
        }
    }
    for (int e = 0; e < EXPONENTS; e++) {
        products sums = {common.cc, gg[e], cg[e], common.cr, gr[e], common.rr};
        float diffuse, amplitude;
        error[(size_t)e * texels + texel] = solve_products(&sums, &diffuse, &amplitude);
    }
}

/* Running mean of `count` values `stride` apart over windows of 2 radius + 1, cut off at the ends. */
static void mean_line(const float *from, float *to, int count, size_t stride, int radius)
{
    double sum = 0;
    int first = 0, end = 0;
    for (int i = 0; i < count; i++) {
        for (; end < count && end <= i + radius; end++)
            sum += (double)from[(size_t)end * stride];
        for (; first < i - radius; first++)
            sum -= (double)from[(size_t)first * stride];
        to[(size_t)i * stride] = (float)(sum / (end - first));
    }
}

/* Three box means each way are a Gaussian of a fortieth of the width, within which a finish rarely changes. */
static void pool(const search *run, float *map, float *scratch)
{
    int width = run->field->width, height = run->field->height;
    double sigma = fmin(fmax(width, height) / 42.0, 12);
    int radius = (int)lround((sqrt(4 * sigma * sigma + 1) - 1) / 2);
    for (int round = 0; radius > 0 && round < 3; round++) {
        for (int y = 0; y < height; y++)
            mean_line(map + (size_t)y * (size_t)width, scratch + (size_t)y * (size_t)width, width, 1, radius);
        for (int x = 0; x < width; x++)
            mean_line(scratch + x, map + x, height, (size_t)width, radius);
    }
}

/* Where candidate `index` is the best so far under a setting, it becomes the choice; of equals the first. */
static void compare_candidate(const search *run, const weft_sparse_worker *worker, int setting, int index,
                              const float *error)
{
    size_t texels = weft_sparse_texel_count(run->field);
    double cost = penalty(&run->setting[setting], candidate_of_index(index));
    float *least = worker->least + (size_t)setting * texels;
    int16_t *choice = worker->choice + (size_t)setting * texels;
    for (size_t texel = 0; isfinite(cost) && texel < texels; texel++) {
        float weighed = error[texel] * (float)cost;
        if (weighed < least[texel] || (weighed == least[texel] && index < choice[texel])) {
            least[texel] = weighed;
            choice[texel] = (int16_t)index;
        }
    }
}

static void try_slope(const search *run, const weft_sparse_worker *worker, int slope)
{
    size_t texels = weft_sparse_texel_count(run->field);
    candidate shape = candidate_of_index(slope * EXPONENTS);
    for (size_t texel = 0; texel < texels; texel++)
        slope_errors(run, texel, shape, worker->error);
    for (size_t e = 0; e < EXPONENTS; e++)
        pool(run, worker->error + e * texels, worker->pooled + e * texels);
    for (int s = 0; s < run->setting_count; s++) {
        for (int e = 0; e < EXPONENTS; e++)
            compare_candidate(run, worker, s, slope * EXPONENTS + e, worker->error + (size_t)e * texels);
    }
}

/* Whether any setting allows a slope. */
static bool is_allowed(const search *run, int slope)
{
    for (int s = 0; s < run->setting_count; s++) {
        if (isfinite(penalty(&run->setting[s], candidate_of_index(slope * EXPONENTS))))
            return true;
    }
    return false;
}

/* ---- The choices of all threads ---- */

static void forget(const search *run, const weft_sparse_worker *worker)
{
    size_t choices = weft_sparse_texel_count(run->field) * (size_t)run->setting_count;
    for (size_t i = 0; i < choices; i++) {
        worker->least[i] = INFINITY;
        worker->choice[i] = 0;
    }
}

/* Brings the best of all workers to the first. */
static void merge(const search *run)
{
    const weft_sparse_worker *first = &run->worker[0];
    size_t choices = weft_sparse_texel_count(run->field) * (size_t)run->setting_count;
    for (int k = 1; k < run->worker_count; k++) {
        const weft_sparse_worker *other = &run->worker[k];
        for (size_t i = 0; i < choices; i++) {
            bool better = other->least[i] < first->least[i];
            bool earlier = other->least[i] == first->least[i] && other->choice[i] < first->choice[i];
            if (better || earlier) {
                first->least[i] = other->least[i];
                first->choice[i] = other->choice[i];
            }
        }
    }
}

/* Neighbourhoods that choose differently would meet at a visible edge, so slopes and the logarithm of the exponent are
 * smoothed as widely as the errors were pooled. `scratch` [4][texel]. */
static void smooth_choices(const search *run, int setting, float *scratch)
{
    size_t texels = weft_sparse_texel_count(run->field);
    const int16_t *choice = run->worker[0].choice + (size_t)setting * texels;
    candidate *shape = run->shape + (size_t)setting * texels;
    for (size_t texel = 0; texel < texels; texel++) {
        candidate chosen = candidate_of_index(choice[texel]);
        scratch[texel] = chosen.slope_x;
        scratch[texels + texel] = chosen.slope_y;
        scratch[2 * texels + texel] = log2f(chosen.exponent);
    }
    for (size_t k = 0; k < 3; k++)
        pool(run, scratch + k * texels, scratch + 3 * texels);
    for (size_t texel = 0; texel < texels; texel++)
        shape[texel] = (candidate){scratch[texel], scratch[texels + texel], exp2f(scratch[2 * texels + texel])};
}

void weft_sparse_search_run(weft_sparse_search *run)
{
    weigh_samples(run);
#pragma omp parallel num_threads(run->worker_count)
    {
        const weft_sparse_worker *worker = &run->worker[omp_get_thread_num()];
        forget(run, worker);
#pragma omp for schedule(dynamic)
        for (int slope = 0; slope < SLOPES * SLOPES; slope++) {
            if (is_allowed(run, slope))
                try_slope(run, worker, slope);
        }
    }
    merge(run);
#pragma omp parallel for schedule(static) num_threads(run->worker_count)
    for (int s = 0; s < run->setting_count; s++)
        smooth_choices(run, s, run->worker[omp_get_thread_num()].error);
}

weft_sparse_texel weft_sparse_search_texel(const weft_sparse_search *run, int setting, size_t texel)
{
    const weft_sparse_field *field = run->field;
    size_t images = (size_t)field->image_count;
    bool lobe = run->setting[setting].largest_exponent > 0;
    candidate shape = lobe ? run->shape[(size_t)setting * weft_sparse_texel_count(field) + texel] : (candidate){0};
    products sums[3] = {{0}};
    for (size_t i = texel * images; i < (texel + 1) * images; i++) {
        if (!(run->weight[i] > 0))
            continue;
        float g = lobe ? lobe_value(shape, field->light + 3 * i, field->view + 3 * i) : 0;
        for (size_t k = 0; k < 3; k++)
            add_product(&sums[k], run->weight[i], field->light[3 * i + 2], g, field->value[3 * i + k]);
    }
    weft_sparse_texel result = {.slope_x = shape.slope_x, .slope_y = shape.slope_y, .exponent = shape.exponent};
    for (int k = 0; k < 3; k++)
        solve_products(&sums[k], &result.diffuse[k], &result.amplitude[k]);
    return result;
}
