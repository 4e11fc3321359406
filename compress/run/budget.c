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

static weft_code add_family(auction *of, const weft_texel_source *whole, int lobes, bool table, bool light,
                            weft_error *error)
{
    family *next = &of->family[of->family_count];
    const weft_material *like = of->material;
    next->source = *whole;
    next->source.options.lobe_count = lobes;
    next->source.options.table = table;
    next->source.light_table = light;
    WEFT_TRY(weft_material_create(like->level[0].width, like->level[0].height, lobes, table ? like->view_count : 0,
                                  light ? like->light_count : 0, like->level_count > 1, &next->material, error));
    of->family_count++;
    for (int view = 0; view < next->material.view_count; view++)
        next->material.view[view] = like->view[view];
    for (int l = 0; l < next->material.light_count; l++)
        next->material.light[l] = like->light[l];
    return WEFT_OK;
}

static weft_code list_families(auction *of, const weft_texel_source *whole, weft_error *error)
{
    int lobes = of->material->lobe_count;
    bool light = of->material->light_count > 0;
    for (int table = 0; table <= (of->material->view_count > 0); table++) {
        for (int i = 0; i <= lobes; i++)
            WEFT_TRY(add_family(of, whole, i, table, false, error));
    }
    return light ? add_family(of, whole, lobes, of->material->view_count > 0, true, error) : WEFT_OK;
}

static void list_candidates(auction *of)
{
    static const int bits[BIT_CHOICES] = {4, 6, 8};
    for (int i = 0; i < of->family_count; i++) {
        const weft_material *material = &of->family[i].material;
        bool table = material->view_count > 0, light = material->light_count > 0;
        for (int choice = table || light ? 0 : BIT_CHOICES - 1; choice < BIT_CHOICES; choice++) {
            weft_candidate *next = &of->candidate[of->judgement.count];
            *next =
                (weft_candidate){material, {material->lobe_count, table ? bits[choice] : 0, light ? bits[choice] : 0}};
            of->bytes[of->judgement.count++] = weft_candidate_bytes(next);
        }
    }
    of->judgement.candidate = of->candidate;
}

static weft_code create_judgement(auction *of, weft_error *error)
{
    for (int k = 0; k < of->material->level_count; k++) {
        size_t count = texel_count(of->material, k) * (size_t)of->judgement.count;
        of->judgement.square_error[k] = calloc(count, sizeof(float));
        if (!of->judgement.square_error[k])
            return weft_fail_memory(error, "errors of candidates", count * sizeof(float));
    }
    return WEFT_OK;
}

/* Fits them all, then measures them all in one pass. All memory is taken before the first fit and
 * the largest model is fitted first, so that too small a limit is noticed before anything is read. */
static weft_code fit_candidates(auction *of, weft_dense_result *result, weft_error *error)
{
    weft_dense_job job = *of->job;
    job.checkpoint_path = NULL;
    list_candidates(of);
    WEFT_TRY(create_judgement(of, error));
    for (int i = of->family_count - 1; i >= 0; i--) {
        weft_dense_result smaller;
        WEFT_TRY(weft_dense_fit(of->dataset, &of->family[i].source, &job, &of->family[i].material,
                                i == of->family_count - 1 ? result : &smaller, error));
    }
    weft_texel_source source = of->family[of->family_count - 1].source;
    weft_dense_result judged;
    source.judgement = &of->judgement;
    return weft_dense_fit(of->dataset, &source, &job, of->material, &judged, error);
}

/* ---- The choice ---- */

static int best_candidate(const auction *of, const float *square_error, double lambda)
{
    int best = 0;
    double least = INFINITY;
    for (int i = 0; i < of->judgement.count; i++) {
        double cost = (double)square_error[i] + lambda * of->bytes[i];
        if (cost < least) {
            least = cost;
            best = i;
        }
    }
    return best;
}

/* Fills the material with the choice for this lambda; `size` of its file, metadata included. */
static weft_code choose(auction *of, double lambda, uint64_t *size, weft_error *error)
{
    for (int k = 0; k < of->material->level_count; k++) {
        for (size_t texel = 0; texel < texel_count(of->material, k); texel++) {
            const float *square_error = of->judgement.square_error[k] + texel * (size_t)of->judgement.count;
            int best = best_candidate(of, square_error, lambda);
            weft_candidate_copy_texel(&of->candidate[best], k, texel, of->material);
        }
    }
    WEFT_TRY(weft_material_find_models(of->material, error));
    WEFT_TRY(weft_material_size(of->material, size, error));
    *size += of->plan->reserve;
    return WEFT_OK;
}

/* A lambda at which one byte is worth a thousandth of the squared error of a texel: where the search begins. */
static double first_lambda(const auction *of)
{
    double sum = 0;
    for (size_t texel = 0; texel < texel_count(of->material, 0); texel++)
        sum += (double)of->judgement.square_error[0][texel * (size_t)of->judgement.count];
    return fmax(sum / (double)texel_count(of->material, 0) * 1e-3, 1e-30);
}

/* From nothing to where the file fits: `low` does not, `high` does. */
static weft_code bracket(auction *of, double *low, double *high, weft_error *error)
{
    uint64_t size;
    *low = *high = 0;
    WEFT_TRY(choose(of, *high, &size, error));
    while (size > of->plan->bytes) {
        *low = *high;
        *high = *high > 0 ? *high * BRACKET : first_lambda(of) / (BRACKET * BRACKET * BRACKET);
        WEFT_TRY(choose(of, *high, &size, error));
    }
    return WEFT_OK;
}

static weft_code check_smallest(auction *of, weft_error *error)
{
    uint64_t size;
    WEFT_TRY(choose(of, LARGEST_LAMBDA, &size, error));
    if (size > of->plan->bytes)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "a budget of %.3f MB is too small: a diffuse term everywhere takes %.3f MB",
                         (double)of->plan->bytes * 1e-6, (double)size * 1e-6);
    return WEFT_OK;
}

/* The smallest lambda, to a few per cent, whose file fits. */
static weft_code spend(auction *of, weft_error *error)
{
    double low, high;
    uint64_t size;
    WEFT_TRY(check_smallest(of, error));
    WEFT_TRY(bracket(of, &low, &high, error));
    for (int i = 0; i < BISECTIONS && high > 0; i++) {
        double middle = low > 0 ? sqrt(low * high) : high / BRACKET;
        WEFT_TRY(choose(of, middle, &size, error));
        if (size > of->plan->bytes)
            low = middle;
        else
            high = middle;
    }
    return choose(of, high, &size, error);
}

/* The material as it will be read, against the samples once more. */
static weft_code measure(auction *of, weft_dense_result *result, weft_error *error)
{
    weft_dense_job job = *of->job;
    weft_dense_result measured;
    weft_texel_source source = of->family[of->family_count - 1].source;
    const weft_candidate whole = {of->material, {of->material->lobe_count, 8, 8}};
    const weft_judgement judgement = {.count = 1, .candidate = &whole};
    job.checkpoint_path = NULL;
    source.judgement = &judgement;
    WEFT_TRY(weft_dense_fit(of->dataset, &source, &job, of->material, &measured, error));
    result->masked = measured.masked;
    result->counts.sums = measured.counts.sums;
    return WEFT_OK;
}

static void free_auction(auction *of)
{
    for (int i = 0; i < of->family_count; i++)
        weft_material_free(&of->family[i].material);
    for (int k = 0; k < WEFT_MATERIAL_MAX_LEVELS; k++)
        free(of->judgement.square_error[k]);
    free(of);
}

weft_code weft_budget_fit(weft_dataset *dataset, const weft_texel_source *source, const weft_dense_job *job,
                          const weft_budget_plan *plan, weft_material *material, weft_dense_result *result,
                          weft_error *error)
{
    auction *of = calloc(1, sizeof *of);
    if (!of)
        return weft_fail_memory(error, "candidates", sizeof *of);
    of->dataset = dataset;
    of->job = job;
    of->plan = plan;
    of->material = material;
    weft_code code = list_families(of, source, error);
    if (code == WEFT_OK)
        code = fit_candidates(of, result, error);
    if (code == WEFT_OK)
        code = spend(of, error);
    if (code == WEFT_OK)
        code = measure(of, result, error);
    free_auction(of);
    return code;
}
