#include "compress/sparse/sparse.h"

#include "base/numeric/error_summary.h"

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

/* Relative RMSE plus median relative error of the left-out image, times its weight; `value` [texel][3] is scratch. */
static weft_code add_score(const weft_sparse_search *run, int setting, weft_compared *value, double *score)
{
    const weft_sparse_field *field = run->field;
    size_t count = 0;
    for (size_t texel = 0; texel < weft_sparse_texel_count(field); texel++) {
        size_t at = texel * (size_t)field->image_count + (size_t)run->left_out;
        if (!(field->weight[at] > 0.5f))
            continue;
        weft_sparse_texel fit = weft_sparse_search_texel(run, setting, texel);
        for (int k = 0; k < 3; k++)
            value[count++] =
                (weft_compared){.sample = field->value[3 * at + (size_t)k],
                                .prediction = weft_sparse_value(&fit, field->light + 3 * at, field->view + 3 * at, k)};
    }
    weft_error_summary summary;
    weft_code code = weft_error_summary_of(value, count, &summary, NULL);
    *score += (summary.relative_rmse + summary.median_relative) * (double)field->image_weight[run->left_out];
    return code;
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
    size_t values = 3 * weft_sparse_texel_count(field);
    size_t bytes = values * (size_t)run.setting_count * sizeof(weft_compared);
    weft_compared *value = malloc(bytes);
    weft_code code =
        value ? weft_sparse_search_create(&run, error) : weft_fail_memory(error, "cross-validation", bytes);
    for (int fold = 0; code == WEFT_OK && fold < field->image_count; fold++) {
        int failures = 0;
        run.left_out = fold;
        weft_sparse_search_run(&run);
#pragma omp parallel for schedule(dynamic) reduction(+ : failures)
        for (int s = 0; s < run.setting_count; s++)
            failures += add_score(&run, s, value + (size_t)s * values, &score[s]) != WEFT_OK;
        if (failures > 0)
            code = weft_fail_memory(error, "cross-validation", bytes);
    }
    int chosen = 0;
    for (int s = 1; s < run.setting_count; s++)
        chosen = score[s] < score[chosen] ? s : chosen;
    *best = setting[chosen];
    weft_sparse_search_free(&run);
    free(value);
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
