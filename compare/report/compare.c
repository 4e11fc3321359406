#include "compare/report/compare.h"

#include "base/atomic_file.h"
#include "btf/dataset/fingerprint.h"
#include "compare/report/page/sections.h"
#include "geometry/stitch/stitch.h"

#include <stdio.h>
#include <string.h>

/* Freed with close_files. */
typedef struct compared_files {
    weft_dataset *dataset;
    weft_material material;
    weft_compared_weave weave;
    weft_predictor *bard; /* NULL: not compared */
} compared_files;

static void weigh(const weft_compare_options *options, const weft_dataset_layout *layout, weft_comparison *comparison)
{
    comparison->dataset_bytes = (double)weft_file_bytes(options->dataset);
    comparison->material_bytes = (double)weft_file_bytes(options->material);
    comparison->half_float_bytes =
        (double)layout->width * layout->height * layout->image_count * 3 * (double)sizeof(weft_half);
}

/* ---- Sample by sample ---- */

static weft_code measure_texture(weft_dataset *dataset, weft_predictor *predictor, const weft_certificate *certificate,
                                 const char *name, const weft_progress *progress, weft_comparison *comparison,
                                 weft_error *error)
{
    int image[WEFT_REPRESENTATIVE_COUNT];
    int image_count = weft_representative_images(weft_dataset_get_layout(dataset), image);
    weft_compared_model *model = &comparison->model[comparison->model_count];
    char step[64];
    snprintf(step, sizeof step, "measuring: %s", name);
    *model = (weft_compared_model){.name = name};
    WEFT_TRY(weft_measurement_make(dataset, predictor, certificate, step, image, image_count, progress, &model->texture,
                                   error));
    comparison->model_count++;
    return WEFT_OK;
}

static weft_code measure_material(const compared_files *files, const weft_progress *progress,
                                  weft_comparison *comparison, weft_error *error)
{
    weft_predictor *predictor;
    WEFT_TRY(weft_predictor_of_material(weft_dataset_get_layout(files->dataset), &files->material, &predictor, error));
    bool certified = comparison->has_held_out && comparison->held_out.has_certificate;
    weft_code code = measure_texture(files->dataset, predictor, certified ? &comparison->held_out.certificate : NULL,
                                     "compressed", progress, comparison, error);
    weft_predictor_free(predictor);
    return code;
}

static weft_code measure_weave(const compared_files *files, const weft_progress *progress, weft_comparison *comparison,
                               weft_error *error)
{
    const weft_compared_weave *weave = &files->weave;
    weft_predictor *predictor;
    if (weave->is_threads)
        WEFT_TRY(weft_predictor_of_threads(weft_dataset_get_layout(files->dataset), &weave->threads.cloth, &predictor,
                                           error));
    else
        WEFT_TRY(weft_predictor_of_weave(weft_dataset_get_layout(files->dataset), NULL, &weave->weave,
                                         &comparison->weave_layout, &predictor, error));
    weft_code code = measure_texture(files->dataset, predictor, NULL, "analytic", progress, comparison, error);
    weft_predictor_free(predictor);
    return code;
}

/* ---- Mean BRDFs ---- */

static weft_code measure_means(const weft_compare_options *options, const compared_files *files,
                               const weft_progress *progress, weft_comparison *comparison, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(files->dataset);
    weft_error_summary mean[WEFT_CONTENDER_COUNT];
    weft_contenders contenders;
    WEFT_TRY(weft_contenders_open(options->dataset, options->material, &files->material, files->weave.path,
                                  options->bard, &contenders, error));
    weft_code code = weft_contenders_measure(&contenders, layout, progress, mean, error);
    if (code == WEFT_OK)
        code = weft_slices_make(layout, &contenders, progress, &comparison->slices, error);
    weft_contenders_close(&contenders);
    for (int i = 0; code == WEFT_OK && i < comparison->model_count; i++)
        comparison->model[i].mean = mean[i + 1];
    return code;
}

static int picture_side(const weft_compare_options *options)
{
    return options->picture_side > 0 ? options->picture_side : WEFT_COMPARE_PICTURE_SIDE;
}

static weft_code draw_scenes(const weft_compare_options *options, const compared_files *files,
                             const weft_progress *progress, weft_comparison *comparison, weft_error *error)
{
    const weft_compared_weave *weave = &files->weave;
    weft_scenes_request request = {
        .dataset = files->dataset, .material = &files->material, .bard = options->bard, .side = picture_side(options)};
    if (options->weave && weave->is_threads)
        request.threads = &weave->threads.cloth;
    else if (options->weave)
        request.weave = &weave->weave;
    request.layout = &comparison->weave_layout;
    return weft_scenes_draw(&request, progress, &comparison->scenes, error);
}

static weft_code measure(const weft_compare_options *options, const compared_files *files,
                         const weft_progress *progress, weft_comparison *comparison, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(files->dataset);
    weigh(options, layout, comparison);
    WEFT_TRY(weft_hold_out_read(files->material.metadata, &comparison->has_held_out, &comparison->held_out, error));
    WEFT_TRY(weft_dataset_fingerprint_compare(files->dataset, files->material.metadata, comparison->warning, error));
    WEFT_TRY(measure_material(files, progress, comparison, error));
    if (options->weave)
        WEFT_TRY(measure_weave(files, progress, comparison, error));
    if (options->bard)
        WEFT_TRY(measure_texture(files->dataset, files->bard, NULL, "BARD", progress, comparison, error));
    WEFT_TRY(measure_means(options, files, progress, comparison, error));
    comparison->has_few_images = layout->image_count < WEFT_COMPARE_FEW_IMAGES;
    WEFT_TRY(draw_scenes(options, files, progress, comparison, error));
    const weft_traced_request truth = {.dataset = files->dataset,
                                       .material = &files->material,
                                       .stitch = options->truth,
                                       .side = picture_side(options),
                                       .paths = options->truth_paths,
                                       .seed = 1};
    return options->truth ? weft_traced_truth_measure(&truth, progress, &comparison->truth, error) : WEFT_OK;
}

/* ---- Page ---- */

static weft_code fill_page(weft_page *page, const weft_dataset_layout *layout, const weft_material *material,
                           const weft_comparison *comparison, weft_error *error)
{
    weft_page_summary(page, layout, comparison);
    weft_page_models(page, comparison);
    WEFT_TRY(weft_page_slices(page, &comparison->slices, error));
    WEFT_TRY(weft_page_scenes(page, &comparison->scenes, error));
    WEFT_TRY(weft_page_truth(page, &comparison->truth, error));
    WEFT_TRY(weft_page_pairs(page, layout, comparison, error));
    return weft_page_numbers(page, layout, material, comparison, error);
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static weft_code write_page(const weft_compare_options *options, const weft_dataset_layout *layout,
                            const weft_material *material, const weft_comparison *comparison, weft_error *error)
{
    char title[512];
    snprintf(title, sizeof title, "%s and %s", base_name(options->dataset), base_name(options->material));
    weft_page page;
    WEFT_TRY(weft_page_begin(options->folder, title, &page, error));
    weft_code code = fill_page(&page, layout, material, comparison, error);
    if (code == WEFT_OK)
        return weft_page_finish(&page, error);
    weft_page_abandon(&page);
    return code;
}

/* ---- All of it ---- */

/* Before hours of work rather than after them. */
static weft_code check_stitch(const char *path, weft_error *error)
{
    weft_stitch stitch;
    WEFT_TRY(weft_stitch_read(path, &stitch, error));
    weft_stitch_free(&stitch);
    return WEFT_OK;
}

static weft_code open_files(const weft_compare_options *options, const weft_progress *progress, compared_files *files,
                            weft_comparison *comparison, weft_error *error)
{
    WEFT_TRY(weft_dataset_open(options->dataset, &files->dataset, error));
    WEFT_TRY(weft_material_read(options->material, &files->material, error));
    if (options->truth)
        WEFT_TRY(check_stitch(options->truth, error));
    if (options->bard)
        WEFT_TRY(weft_predictor_of_dataset(files->dataset, options->bard, &files->bard, error));
    if (!options->weave)
        return WEFT_OK;
    return weft_compare_weave_open(options, files->dataset, progress, &files->weave, comparison, error);
}

static void close_files(compared_files *files)
{
    weft_dataset_close(files->dataset);
    weft_material_free(&files->material);
    weft_compare_weave_close(&files->weave);
    weft_predictor_free(files->bard);
}

weft_code weft_compare(const weft_compare_options *options, const weft_progress *progress, weft_comparison *comparison,
                       weft_error *error)
{
    compared_files files = {0};
    *comparison = (weft_comparison){0};
    weft_code code = open_files(options, progress, &files, comparison, error);
    if (code == WEFT_OK)
        code = measure(options, &files, progress, comparison, error);
    if (code == WEFT_OK)
        code = write_page(options, weft_dataset_get_layout(files.dataset), &files.material, comparison, error);
    close_files(&files);
    if (code != WEFT_OK)
        weft_comparison_free(comparison);
    return code;
}

void weft_comparison_free(weft_comparison *comparison)
{
    for (int i = 0; i < comparison->model_count; i++)
        weft_measurement_free(&comparison->model[i].texture);
    weft_slices_free(&comparison->slices);
    weft_scenes_free(&comparison->scenes);
    weft_traced_truth_free(&comparison->truth);
}
