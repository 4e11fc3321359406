#include "compare/report/compare.h"

#include <math.h>
#include <stdlib.h>

enum { MEAN_TEXELS = 1024, MEAN_IMAGES = 7000 };

static weft_real level_for_means(const weft_material *material)
{
    int level = 0;
    while (level + 1 < material->level_count &&
           (long)material->level[level].width * material->level[level].height > MEAN_TEXELS)
        level++;
    return level;
}

static weft_code add(weft_contenders *contenders, const char *name, const char *path, weft_real level,
                     weft_error *error)
{
    const weft_model_options options = {0};
    weft_contender *contender = &contenders->contender[contenders->count];
    *contender = (weft_contender){.name = name, .level = level};
    WEFT_TRY(weft_model_open(path, &options, &contender->model, error));
    contenders->count++;
    return WEFT_OK;
}

weft_code weft_contenders_open(const char *dataset, const char *material_path, const weft_material *material,
                               const char *weave, const char *bard, weft_contenders *contenders, weft_error *error)
{
    *contenders = (weft_contenders){0};
    weft_code code = add(contenders, "data", dataset, 0, error);
    if (code == WEFT_OK)
        code = add(contenders, "compressed", material_path, level_for_means(material), error);
    if (code == WEFT_OK && weave)
        code = add(contenders, "analytic", weave, 0, error);
    if (code == WEFT_OK && bard)
        code = add(contenders, "BARD", bard, 0, error);
    if (code != WEFT_OK)
        weft_contenders_close(contenders);
    return code;
}

void weft_contenders_close(weft_contenders *contenders)
{
    for (int i = 0; i < contenders->count; i++)
        weft_model_close(contenders->contender[i].model);
    *contenders = (weft_contenders){0};
}

weft_code weft_contender_brdf(const weft_contender *contender, weft_vec3 light, weft_vec3 view, weft_rgb *brdf,
                              weft_error *error)
{
    const weft_query query = {.light = light, .view = view, .level = contender->level};
    return weft_model_brdf(contender->model, &query, brdf, error);
}

/* ---- Error ---- */

/* Values of the data and of all models for the same directions. */
typedef struct mean_values {
    long count; /* of directions with data */
    weft_compared *value[WEFT_CONTENDER_COUNT];
} mean_values;

static void keep(weft_compared value[3], weft_rgb prediction, weft_rgb sample)
{
    value[0] = (weft_compared){.sample = (float)sample.r, .prediction = (float)prediction.r};
    value[1] = (weft_compared){.sample = (float)sample.g, .prediction = (float)prediction.g};
    value[2] = (weft_compared){.sample = (float)sample.b, .prediction = (float)prediction.b};
}

static weft_code evaluate_image(const weft_contenders *contenders, const weft_dataset_layout *layout, int image,
                                mean_values *values, weft_error *error)
{
    int x = layout->width / 2, y = layout->height / 2;
    weft_vec3 light = weft_dataset_light_direction(layout, image, x, y);
    weft_vec3 view = weft_dataset_view_direction(layout, layout->view_of_image[image], x, y);
    weft_rgb sample, prediction;
    if (!(light.z > 0 && view.z > 0))
        return WEFT_OK;
    WEFT_TRY(weft_contender_brdf(&contenders->contender[0], light, view, &sample, error));
    if (isnan(sample.r))
        return WEFT_OK;
    for (int i = 1; i < contenders->count; i++) {
        WEFT_TRY(weft_contender_brdf(&contenders->contender[i], light, view, &prediction, error));
        keep(values->value[i] + 3 * values->count, prediction, sample);
    }
    values->count++;
    return WEFT_OK;
}

static weft_code evaluate(const weft_contenders *contenders, const weft_dataset_layout *layout,
                          const weft_progress *progress, mean_values *values, weft_error *error)
{
    int stride = (layout->image_count + MEAN_IMAGES - 1) / MEAN_IMAGES;
    for (int i = 1; i < contenders->count; i++) {
        size_t bytes = 3 * (size_t)layout->image_count * sizeof(weft_compared);
        values->value[i] = malloc(bytes);
        if (!values->value[i])
            return weft_fail_memory(error, "mean BRDFs", bytes);
    }
    for (int image = 0; image < layout->image_count; image += stride) {
        WEFT_TRY(evaluate_image(contenders, layout, image, values, error));
        weft_progress_report(progress, "mean BRDFs", image + 1, layout->image_count);
    }
    return WEFT_OK;
}

weft_code weft_contenders_measure(const weft_contenders *contenders, const weft_dataset_layout *layout,
                                  const weft_progress *progress, weft_error_summary *result, weft_error *error)
{
    mean_values values = {0};
    weft_code code = evaluate(contenders, layout, progress, &values, error);
    result[0] = (weft_error_summary){0};
    for (int i = 1; i < contenders->count && code == WEFT_OK; i++)
        code = weft_error_summary_of(values.value[i], 3 * (size_t)values.count, &result[i], error);
    for (int i = 1; i < contenders->count; i++)
        free(values.value[i]);
    return code;
}
