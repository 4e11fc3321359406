#include "evaluate/model.h"

#include "btf/file_kind.h"
#include "btf/material/certificate.h"
#include "reflectance/components/components.h"
#include "reflectance/lafortune/lafortune.h"
#include "reflectance/microcylinder/file.h"

#include <stdlib.h>
#include <string.h>

struct weft_model {
    weft_file_kind kind;
    uint64_t noise_seed;
    weft_material material;
    weft_table_directions directions; /* of the material */
    bool has_interval;
    weft_certificate certificate; /* of the material, where intervals are asked for */
    weft_component_maps maps;     /* of its components; empty without, or where its lobes are asked for */
    weft_material_relief relief;  /* through which they are seen, where the material has heights */
    weft_dataset *dataset;
    weft_raw_btf *raw;
    weft_weave weave;
    weft_prepared_cloth cloth; /* of microcylinders */
    weft_cloth_weighting weighting;
};

/* ---- Opening ---- */

/* Of the lobes beside components nothing is certified. */
static weft_code open_certificate(weft_model *model, const char *path, const weft_model_options *options,
                                  weft_error *error)
{
    if (options->lobes && model->material.components)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "the certificate of '%s' is of its components, not of the lobes beside them", path);
    WEFT_TRY(weft_certificate_read(model->material.metadata, &model->has_interval, &model->certificate, error));
    return model->has_interval
               ? WEFT_OK
               : weft_fail(error, WEFT_BAD_INPUT,
                           "'%s' has no certificate: weft compress makes one unless --hold-out is off", path);
}

static weft_code open_components(weft_model *model, weft_error *error)
{
    WEFT_TRY(weft_component_maps_create(model->material.components, &model->maps, error));
    if (!model->material.heights)
        return WEFT_OK;
    WEFT_TRY(weft_component_maps_keep_views(&model->maps, error));
    return weft_material_relief_create(&model->material, &model->relief, error);
}

static weft_code open_material(weft_model *model, const char *path, const weft_model_options *options,
                               weft_error *error)
{
    WEFT_TRY(weft_material_read(path, &model->material, error));
    if (options->lobes && !model->material.has_lobes)
        return weft_fail(error, WEFT_BAD_USAGE, "'%s' has components alone, no lobes", path);
    if (options->interval)
        WEFT_TRY(open_certificate(model, path, options, error));
    if (model->material.components && !options->lobes)
        WEFT_TRY(open_components(model, error));
    return weft_table_directions_create(&model->material, &model->directions, error);
}

static weft_code open_dataset(weft_model *model, const char *path, const weft_model_options *options, weft_error *error)
{
    WEFT_TRY(weft_dataset_open(path, &model->dataset, error));
    WEFT_TRY(weft_raw_btf_create(model->dataset, &model->raw, error));
    if (options->flat)
        weft_raw_btf_flatten(model->raw);
    return WEFT_OK;
}

static weft_code open_weave(weft_model *model, const char *path, const weft_model_options *options, weft_error *error)
{
    return weft_weave_read(path, options->parameter, options->parameter_count, &model->weave, NULL, error);
}

static weft_code open_microcylinder(weft_model *model, const char *path, const weft_model_options *options,
                                    weft_error *error)
{
    weft_microcylinder_description description;
    WEFT_TRY(weft_microcylinder_read(path, options->parameter, options->parameter_count, &description, error));
    model->cloth = weft_microcylinder_prepare(&description.cloth);
    return WEFT_OK;
}

weft_code weft_model_open(const char *path, const weft_model_options *options, weft_model **result, weft_error *error)
{
    static const weft_model_options usual = {0};
    weft_model *model = calloc(1, sizeof *model);
    if (!model)
        return weft_fail_memory(error, "model", sizeof *model);
    options = options ? options : &usual;
    model->noise_seed = options->noise_seed;
    model->weighting = options->as_printed ? WEFT_CLOTH_AS_PRINTED : WEFT_CLOTH_BY_AREA;
    weft_code code = weft_file_kind_of(path, &model->kind, error);
    if (code == WEFT_OK && options->interval && model->kind != WEFT_FILE_MATERIAL)
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s': only a .weft has a certificate", path);
    else if (code == WEFT_OK && model->kind == WEFT_FILE_SESSION)
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s' is a folder, not a model (.weft, .btf.h5, .wv or .mc)", path);
    else if (code == WEFT_OK && model->kind == WEFT_FILE_STITCH)
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s' is a stitch, not a model; weft simulate makes a .btf.h5 of it",
                         path);
    else if (code == WEFT_OK && model->kind == WEFT_FILE_MATERIAL)
        code = open_material(model, path, options, error);
    else if (code == WEFT_OK && model->kind == WEFT_FILE_DATASET)
        code = open_dataset(model, path, options, error);
    else if (code == WEFT_OK && model->kind == WEFT_FILE_MICROCYLINDER)
        code = open_microcylinder(model, path, options, error);
    else if (code == WEFT_OK && model->kind == WEFT_FILE_WEAVE)
        code = open_weave(model, path, options, error);
    else if (code == WEFT_OK)
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s' is no model (.weft, .btf.h5, .wv or .mc)", path);
    if (code != WEFT_OK)
        weft_model_close(model);
    else
        *result = model;
    return code;
}

void weft_model_close(weft_model *model)
{
    if (!model)
        return;
    weft_raw_btf_free(model->raw);
    weft_dataset_close(model->dataset);
    weft_table_directions_free(&model->directions);
    weft_component_maps_free(&model->maps);
    weft_material_relief_free(&model->relief);
    weft_material_free(&model->material);
    weft_weave_free(&model->weave);
    free(model);
}

/* ---- Evaluating ---- */

static weft_rgb divided(weft_rgb value, weft_real divisor)
{
    return (weft_rgb){value.r / divisor, value.g / divisor, value.b / divisor};
}

/* Components are reflectance times the cosine of the light, bounded by multiples of it. */
static weft_rgb without_cosine(weft_rgb value, weft_real cosine)
{
    return cosine > 0 ? divided(value, cosine) : (weft_rgb){0};
}

/* BRDF x pi; `factor` is that of the components, where those are evaluated. */
static weft_rgb texel_value(const weft_model *model, int level, int x, int y, const weft_query *query,
                            const float *factor)
{
    const weft_components *components = model->maps.components;
    if (components && !(query->view.z > 0))
        return (weft_rgb){0};
    if (components)
        return without_cosine(
            weft_components_texel(components, components->component_count, factor, level, x, y, query->light.z),
            query->light.z);
    weft_rgba value = weft_material_texel(&model->material, &model->directions, level, x, y, query->light, query->view);
    return (weft_rgb){value.r, value.g, value.b};
}

static void find_factor(const weft_model *model, const weft_query *query, float factor[3 * WEFT_COMPONENTS_MAX])
{
    if (model->maps.components)
        weft_component_factors(&model->maps, query->light, query->view, factor);
}

/* Sum over the texels of a row, BRDF x pi. */
static void add_row(const weft_model *model, int level, int y, const weft_query *query, const float *factor,
                    double sum[3])
{
    for (int x = 0; x < model->material.level[level].width; x++) {
        weft_rgb value = texel_value(model, level, x, y, query, factor);
        sum[0] += value.r;
        sum[1] += value.g;
        sum[2] += value.b;
    }
}

/* So few are done sooner than other threads are woken. */
enum { FEW_ROWS = 64 };

/* BRDF x pi. */
static weft_rgb level_mean(const weft_model *model, int level, const weft_query *query)
{
    const weft_material_level *at = &model->material.level[level];
    double r = 0, g = 0, b = 0;
    float factor[3 * WEFT_COMPONENTS_MAX];
    find_factor(model, query, factor);
#pragma omp parallel for reduction(+ : r, g, b) if (at->height > FEW_ROWS)
    for (int y = 0; y < at->height; y++) {
        double sum[3] = {0};
        add_row(model, level, y, query, factor, sum);
        r += sum[0];
        g += sum[1];
        b += sum[2];
    }
    double texels = (double)at->width * at->height;
    return (weft_rgb){r / texels, g / texels, b / texels};
}

static weft_rgb material_mean(const weft_model *model, const weft_query *query)
{
    int last = model->material.level_count - 1;
    weft_real level = weft_clamp(query->level, 0, last);
    int fine = (int)level;
    weft_real share = level - fine;
    weft_rgb mean = level_mean(model, fine, query);
    if (!(share > 0))
        return mean;
    weft_rgb coarse = level_mean(model, fine + 1, query);
    return (weft_rgb){mean.r + share * (coarse.r - mean.r), mean.g + share * (coarse.g - mean.g),
                      mean.b + share * (coarse.b - mean.b)};
}

/* BRDF x pi at a place. */
static weft_rgb material_sample(const weft_model *model, const weft_query *query)
{
    const weft_components *components = model->maps.components;
    if (components)
        return without_cosine(weft_components_sample_through(&model->maps, &model->relief, components->component_count,
                                                             query->level, query->u, query->v, query->light,
                                                             query->view),
                              query->light.z);
    weft_rgba sample = weft_material_sample(&model->material, &model->directions, query->level, query->u, query->v,
                                            query->light, query->view);
    return (weft_rgb){sample.r, sample.g, sample.b};
}

static weft_rgb material_brdf(const weft_model *model, const weft_query *query)
{
    return divided(query->has_place ? material_sample(model, query) : material_mean(model, query), WEFT_PI);
}

static weft_rgb weave_brdf(const weft_model *model, const weft_query *query)
{
    if (!query->has_place)
        return weft_weave_mean_brdf(&model->weave, query->light, query->view);
    weft_weave_point point = weft_weave_locate(&model->weave, query->u, query->v, model->noise_seed);
    return weft_weave_brdf(&model->weave, &point, query->light, query->view);
}

weft_code weft_model_brdf(weft_model *model, const weft_query *query, weft_rgb *brdf, weft_error *error)
{
    if (!(query->level >= 0))
        return weft_fail(error, WEFT_BAD_INPUT, "level %g is negative", query->level);
    if (query->level > 0 && model->kind != WEFT_FILE_MATERIAL)
        return weft_fail(error, WEFT_BAD_INPUT, "level %g: only a .weft has levels", query->level);
    if (model->kind == WEFT_FILE_MATERIAL)
        *brdf = material_brdf(model, query);
    else if (model->kind == WEFT_FILE_WEAVE)
        *brdf = weave_brdf(model, query);
    else if (model->kind == WEFT_FILE_MICROCYLINDER)
        *brdf = weft_microcylinder_brdf(&model->cloth, model->weighting, query->light, query->view);
    else if (query->has_place)
        return weft_raw_btf_sample(model->raw, query->u, query->v, query->light, query->view, brdf, error);
    else
        return weft_raw_btf_mean(model->raw, query->light, query->view, brdf, error);
    return WEFT_OK;
}

/* The certificate is of reflectance times cosine: BRDF x pi x l_z. */
weft_rgb weft_model_half_width(const weft_model *model, const weft_query *query, const weft_rgb *brdf)
{
    double factor = WEFT_PI * (double)query->light.z;
    const double value[3] = {(double)brdf->r, (double)brdf->g, (double)brdf->b};
    double half[3] = {0};
    for (int c = 0; c < 3 && factor > 0; c++)
        half[c] = weft_certificate_half_width(&model->certificate, (double)query->level, factor * value[c],
                                              query->light, query->view) /
                  factor;
    return (weft_rgb){half[0], half[1], half[2]};
}

bool weft_model_has_interval(const weft_model *model)
{
    return model->has_interval;
}

const weft_material *weft_model_material(const weft_model *model)
{
    return model->kind == WEFT_FILE_MATERIAL ? &model->material : NULL;
}

bool weft_model_is_thread_safe(const weft_model *model)
{
    return model->kind != WEFT_FILE_DATASET;
}

weft_real weft_model_opacity(const weft_model *model, const weft_query *query)
{
    if (!(query->view.z > 0))
        return 0;
    if (model->kind != WEFT_FILE_MATERIAL)
        return 1;
    return weft_material_sample(&model->material, &model->directions, query->level, query->u, query->v, query->view,
                                query->view)
        .a;
}
