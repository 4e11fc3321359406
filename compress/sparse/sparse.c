#include "compress/sparse/sparse.h"

#include "compress/sparse/search.h"

#include <math.h>
#include <stdlib.h>

enum { CROSS_VALIDATION_SIDE = 128 };

weft_code weft_sparse_fit(const weft_sparse_field *field, const weft_sparse_setting *setting, weft_sparse_texel *result,
                          weft_error *error)
{
    weft_sparse_search run = {.field = field, .left_out = -1, .setting_count = 1, .setting = setting};
    weft_code code = weft_sparse_search_create(&run, error);
    if (code == WEFT_OK) {
        weft_sparse_search_run(&run);
        for (size_t texel = 0; texel < weft_sparse_texel_count(field); texel++)
            result[texel] = weft_sparse_search_texel(&run, 0, texel);
    }
    weft_sparse_search_free(&run);
    return code;
}

/* ---- Cross-validation ---- */

static int compare_floats(const void *left, const void *right)
{
    const float *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

/* Relative RMSE plus median relative error of the left-out image; `relative` [texel][3] is scratch. */
static double prediction_error(const weft_sparse_search *run, int setting, float *relative)
{
    const weft_sparse_field *field = run->field;
    double square = 0, square_error = 0;
    size_t count = 0;
    for (size_t texel = 0; texel < weft_sparse_texel_count(field); texel++) {
        size_t at = texel * (size_t)field->image_count + (size_t)run->left_out;
        if (!(field->weight[at] > 0.5f))
            continue;
        weft_sparse_texel fit = weft_sparse_search_texel(run, setting, texel);
        for (int k = 0; k < 3; k++) {
            float sample = field->value[3 * at + (size_t)k];
            float error = weft_sparse_value(&fit, field->light + 3 * at, field->view + 3 * at, k) - sample;
            square += (double)(sample * sample);
            square_error += (double)(error * error);
            relative[count++] = fabsf(error) / fmaxf(sample, 1e-6f);
        }
    }
    if (count == 0 || !(square > 0))
        return 0;
    qsort(relative, count, sizeof *relative, compare_floats);
    return sqrt(square_error / square) + (double)relative[count / 2];
}

static int list_settings(weft_sparse_setting *setting)
{
    const double stiffness[3] = {INFINITY, 80, 20};
    int count = 0;
    setting[count++] = (weft_sparse_setting){.largest_exponent = 0, .stiffness = INFINITY};
    for (int i = 0; i < 3; i++) {
        for (int e = 3; e < WEFT_SPARSE_EXPONENTS; e++)
            setting[count++] = (weft_sparse_setting){
                .largest_exponent = (double)WEFT_SPARSE_FIRST_EXPONENT * exp2(0.5 * e), .stiffness = stiffness[i]};
    }
    return count;
}

static weft_code cross_validate(const weft_sparse_field *field, weft_sparse_setting *best, weft_error *error)
{
    weft_sparse_setting setting[WEFT_SPARSE_SETTINGS];
    double score[WEFT_SPARSE_SETTINGS] = {0};
    weft_sparse_search run = {.field = field, .setting = setting, .setting_count = list_settings(setting)};
    size_t errors = 3 * weft_sparse_texel_count(field), bytes = errors * (size_t)run.setting_count * sizeof(float);
    float *relative = malloc(bytes);
    weft_code code =
        relative ? weft_sparse_search_create(&run, error) : weft_fail_memory(error, "cross-validation", bytes);
    for (int fold = 0; code == WEFT_OK && fold < field->image_count; fold++) {
        run.left_out = fold;
        weft_sparse_search_run(&run);
#pragma omp parallel for schedule(dynamic)
        for (int s = 0; s < run.setting_count; s++)
            score[s] += prediction_error(&run, s, relative + (size_t)s * errors);
    }
    int chosen = 0;
    for (int s = 1; s < run.setting_count; s++)
        chosen = score[s] < score[chosen] ? s : chosen;
    *best = setting[chosen];
    weft_sparse_search_free(&run);
    free(relative);
    return code;
}

weft_code weft_sparse_choose(const weft_sparse_field *field, bool lobes, weft_sparse_setting *setting,
                             weft_error *error)
{
    *setting = (weft_sparse_setting){.largest_exponent = 0, .stiffness = INFINITY};
    if (!lobes || field->image_count < 4)
        return WEFT_OK;
    weft_sparse_field small = *field, next;
    weft_code code = WEFT_OK;
    while (code == WEFT_OK && (small.width > CROSS_VALIDATION_SIDE || small.height > CROSS_VALIDATION_SIDE)) {
        code = weft_sparse_field_halve(&small, &next, error);
        if (small.light != field->light)
            weft_sparse_field_free(&small);
        if (code == WEFT_OK)
            small = next;
    }
    if (code == WEFT_OK)
        code = cross_validate(&small, setting, error);
    if (small.light && small.light != field->light)
        weft_sparse_field_free(&small);
    return code;
}
