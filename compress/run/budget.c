#include "compress/run/budget.h"

#include <math.h>
#include <stdlib.h>

enum {
    MOST_FAMILIES = 2 * (WEFT_MATERIAL_MAX_LOBES + 1) + 1,
    BIT_CHOICES = 3,
    MOST_CANDIDATES = BIT_CHOICES * MOST_FAMILIES,
    BISECTIONS = 10
};

#define LARGEST_LAMBDA 1e300 /* the smallest model whatever it leaves */
#define BRACKET 8.0          /* the factor by which lambda grows until the file is small enough */

/* All texels fitted with one model. */
typedef struct family {
    weft_texel_source source;
    weft_material material;
} family;

typedef struct auction {
    weft_dataset *dataset;
    const weft_dense_job *job;
    const weft_budget_plan *plan;
    weft_material *material; /* the one that is wanted */
    family family[MOST_FAMILIES];
    int family_count;
    weft_candidate candidate[MOST_CANDIDATES];
    double bytes[MOST_CANDIDATES];
    weft_judgement judgement;
} auction;

static size_t texel_count(const weft_material *material, int level)
{
    return (size_t)material->level[level].width * (size_t)material->level[level].height;
}

/* ---- Candidates ---- */

static weft_code add_family(auction *sale, const weft_texel_source *whole, int lobes, bool table, bool light,
                            weft_error *error)
{
    family *next = &sale->family[sale->family_count];
    const weft_material *like = sale->material;
    next->source = *whole;
    next->source.options.lobe_count = lobes;
    next->source.options.table = table;
    next->source.light_table = light;
    WEFT_TRY(weft_material_create(like->level[0].width, like->level[0].height, lobes, table ? like->view_count : 0,
                                  light ? like->light_count : 0, like->level_count > 1, &next->material, error));
    sale->family_count++;
    for (int view = 0; view < next->material.view_count; view++)
        next->material.view[view] = like->view[view];
    for (int l = 0; l < next->material.light_count; l++)
        next->material.light[l] = like->light[l];
    return WEFT_OK;
}

static weft_code list_families(auction *sale, const weft_texel_source *whole, weft_error *error)
{
    int lobes = sale->material->lobe_count;
    bool light = sale->material->light_count > 0;
    for (int table = 0; table <= (sale->material->view_count > 0); table++) {
        for (int i = 0; i <= lobes; i++)
            WEFT_TRY(add_family(sale, whole, i, table, false, error));
    }
    return light ? add_family(sale, whole, lobes, sale->material->view_count > 0, true, error) : WEFT_OK;
}

static void list_candidates(auction *sale)
{
    static const int bits[BIT_CHOICES] = {4, 6, 8};
    for (int i = 0; i < sale->family_count; i++) {
        const weft_material *material = &sale->family[i].material;
        bool table = material->view_count > 0, light = material->light_count > 0;
        for (int choice = table || light ? 0 : BIT_CHOICES - 1; choice < BIT_CHOICES; choice++) {
            weft_candidate *next = &sale->candidate[sale->judgement.count];
            *next =
                (weft_candidate){material, {material->lobe_count, table ? bits[choice] : 0, light ? bits[choice] : 0}};
            sale->bytes[sale->judgement.count++] = weft_candidate_bytes(next);
        }
    }
    sale->judgement.candidate = sale->candidate;
}

static weft_code create_judgement(auction *sale, weft_error *error)
{
    for (int k = 0; k < sale->material->level_count; k++) {
        size_t count = texel_count(sale->material, k) * (size_t)sale->judgement.count;
        sale->judgement.square_error[k] = calloc(count, sizeof(float));
        if (!sale->judgement.square_error[k])
            return weft_fail_memory(error, "errors of candidates", count * sizeof(float));
    }
    return WEFT_OK;
}

/* Fits them all, then measures them all in one pass. All memory is taken before the first fit and
 * the largest model is fitted first, so that too small a limit is noticed before anything is read. */
static weft_code fit_candidates(auction *sale, weft_dense_result *result, weft_error *error)
{
    weft_dense_job job = *sale->job;
    job.checkpoint_path = NULL;
    list_candidates(sale);
    WEFT_TRY(create_judgement(sale, error));
    for (int i = sale->family_count - 1; i >= 0; i--) {
        weft_dense_result smaller;
        WEFT_TRY(weft_dense_fit(sale->dataset, &sale->family[i].source, &job, &sale->family[i].material,
                                i == sale->family_count - 1 ? result : &smaller, error));
    }
    weft_texel_source source = sale->family[sale->family_count - 1].source;
    weft_dense_result judged;
    source.judgement = &sale->judgement;
    return weft_dense_fit(sale->dataset, &source, &job, sale->material, &judged, error);
}

/* ---- The choice ---- */

static int best_candidate(const auction *sale, const float *square_error, double lambda)
{
    int best = 0;
    double least = INFINITY;
    for (int i = 0; i < sale->judgement.count; i++) {
        double cost = (double)square_error[i] + lambda * sale->bytes[i];
        if (cost < least) {
            least = cost;
            best = i;
        }
    }
    return best;
}

/* Fills the material with the choice for this lambda; `size` of its file, metadata included. */
static weft_code choose(auction *sale, double lambda, uint64_t *size, weft_error *error)
{
    for (int k = 0; k < sale->material->level_count; k++) {
        for (size_t texel = 0; texel < texel_count(sale->material, k); texel++) {
            const float *square_error = sale->judgement.square_error[k] + texel * (size_t)sale->judgement.count;
            int best = best_candidate(sale, square_error, lambda);
            weft_candidate_copy_texel(&sale->candidate[best], k, texel, sale->material);
        }
    }
    WEFT_TRY(weft_material_find_models(sale->material, error));
    WEFT_TRY(weft_material_size(sale->material, size, error));
    *size += sale->plan->reserve;
    return WEFT_OK;
}

/* A lambda at which one byte is worth a thousandth of the squared error of a texel: where the search begins. */
static double first_lambda(const auction *sale)
{
    double sum = 0;
    for (size_t texel = 0; texel < texel_count(sale->material, 0); texel++)
        sum += (double)sale->judgement.square_error[0][texel * (size_t)sale->judgement.count];
    return fmax(sum / (double)texel_count(sale->material, 0) * 1e-3, 1e-30);
}

/* From nothing to where the file fits: `low` does not, `high` does. */
static weft_code bracket(auction *sale, double *low, double *high, weft_error *error)
{
    uint64_t size;
    *low = *high = 0;
    WEFT_TRY(choose(sale, *high, &size, error));
    while (size > sale->plan->bytes) {
        *low = *high;
        *high = *high > 0 ? *high * BRACKET : first_lambda(sale) / (BRACKET * BRACKET * BRACKET);
        WEFT_TRY(choose(sale, *high, &size, error));
    }
    return WEFT_OK;
}

static weft_code check_smallest(auction *sale, weft_error *error)
{
    uint64_t size;
    WEFT_TRY(choose(sale, LARGEST_LAMBDA, &size, error));
    if (size > sale->plan->bytes)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "a budget of %.3f MB is too small: a diffuse term everywhere takes %.3f MB",
                         (double)sale->plan->bytes * 1e-6, (double)size * 1e-6);
    return WEFT_OK;
}

/* The smallest lambda, to a few per cent, whose file fits. */
static weft_code spend(auction *sale, weft_error *error)
{
    double low, high;
    uint64_t size;
    WEFT_TRY(check_smallest(sale, error));
    WEFT_TRY(bracket(sale, &low, &high, error));
    for (int i = 0; i < BISECTIONS && high > 0; i++) {
        double middle = low > 0 ? sqrt(low * high) : high / BRACKET;
        WEFT_TRY(choose(sale, middle, &size, error));
        if (size > sale->plan->bytes)
            low = middle;
        else
            high = middle;
    }
    return choose(sale, high, &size, error);
}

/* The material as it will be read, against the samples once more. */
static weft_code measure(auction *sale, weft_dense_result *result, weft_error *error)
{
    weft_dense_job job = *sale->job;
    weft_dense_result measured;
    weft_texel_source source = sale->family[sale->family_count - 1].source;
    const weft_candidate whole = {sale->material, {sale->material->lobe_count, 8, 8}};
    const weft_judgement judgement = {.count = 1, .candidate = &whole};
    job.checkpoint_path = NULL;
    source.judgement = &judgement;
    WEFT_TRY(weft_dense_fit(sale->dataset, &source, &job, sale->material, &measured, error));
    result->masked = measured.masked;
    result->counts.sums = measured.counts.sums;
    return WEFT_OK;
}

static void free_auction(auction *sale)
{
    for (int i = 0; i < sale->family_count; i++)
        weft_material_free(&sale->family[i].material);
    for (int k = 0; k < WEFT_MATERIAL_MAX_LEVELS; k++)
        free(sale->judgement.square_error[k]);
    free(sale);
}

weft_code weft_budget_fit(weft_dataset *dataset, const weft_texel_source *source, const weft_dense_job *job,
                          const weft_budget_plan *plan, weft_material *material, weft_dense_result *result,
                          weft_error *error)
{
    auction *sale = calloc(1, sizeof *sale);
    if (!sale)
        return weft_fail_memory(error, "candidates", sizeof *sale);
    sale->dataset = dataset;
    sale->job = job;
    sale->plan = plan;
    sale->material = material;
    weft_code code = list_families(sale, source, error);
    if (code == WEFT_OK)
        code = fit_candidates(sale, result, error);
    if (code == WEFT_OK)
        code = spend(sale, error);
    if (code == WEFT_OK)
        code = measure(sale, result, error);
    free_auction(sale);
    return code;
}
