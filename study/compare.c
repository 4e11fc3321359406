#include "study/compare.h"

#include "btf/dataset_fingerprint.h"
#include "study/compare_page.h"
#include "study/representative.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static double file_bytes(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 ? (double)status.st_size : 0;
}

static void weigh(const weft_compare_options *options, const weft_dataset_layout *layout, weft_comparison *comparison)
{
    comparison->dataset_bytes = file_bytes(options->dataset);
    comparison->material_bytes = file_bytes(options->material);
    comparison->half_float_bytes =
        (double)layout->width * layout->height * layout->image_count * 3 * (double)sizeof(weft_half);
}

static weft_code measure(const weft_compare_options *options, weft_dataset *dataset, const weft_material *material,
                         const weft_progress *progress, weft_comparison *comparison, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    int image[WEFT_REPRESENTATIVE_COUNT];
    int image_count = weft_representative_images(layout, image);
    weigh(options, layout, comparison);
    WEFT_TRY(weft_measurement_make(dataset, material, image, image_count, progress, &comparison->measurement, error));
    if (layout->image_count > 1 && layout->image_count < WEFT_LEAVE_ONE_OUT_LIMIT)
        WEFT_TRY(weft_leave_one_out_measure(dataset, progress, &comparison->left_out, error));
    const weft_scenes_request request = {dataset, material, options->weave, options->tiles_u, options->tiles_v};
    return weft_scenes_draw(&request, progress, &comparison->scenes, error);
}

static weft_code fill_page(weft_page *page, const weft_dataset_layout *layout, const weft_material *material,
                           const weft_comparison *comparison, weft_error *error)
{
    weft_page_summary(page, layout, comparison);
    WEFT_TRY(weft_page_scenes(page, &comparison->scenes, error));
    WEFT_TRY(weft_page_left_out(page, &comparison->left_out, error));
    WEFT_TRY(weft_page_pairs(page, layout, &comparison->measurement, error));
    weft_page_numbers(page, layout, material, comparison);
    return WEFT_OK;
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

static weft_code compare(const weft_compare_options *options, weft_dataset *dataset, const weft_progress *progress,
                         weft_comparison *comparison, weft_error *error)
{
    weft_material material;
    WEFT_TRY(weft_material_read(options->material, &material, error));
    weft_code code = measure(options, dataset, &material, progress, comparison, error);
    if (code == WEFT_OK)
        code = weft_dataset_fingerprint_compare(dataset, material.metadata, comparison->warning, error);
    if (code == WEFT_OK)
        code = write_page(options, weft_dataset_get_layout(dataset), &material, comparison, error);
    weft_material_free(&material);
    return code;
}

weft_code weft_compare(const weft_compare_options *options, const weft_progress *progress, weft_comparison *comparison,
                       weft_error *error)
{
    *comparison = (weft_comparison){0};
    weft_dataset *dataset;
    WEFT_TRY(weft_dataset_open(options->dataset, &dataset, error));
    weft_code code = compare(options, dataset, progress, comparison, error);
    weft_dataset_close(dataset);
    if (code != WEFT_OK)
        weft_comparison_free(comparison);
    return code;
}

void weft_comparison_free(weft_comparison *comparison)
{
    weft_measurement_free(&comparison->measurement);
    weft_leave_one_out_free(&comparison->left_out);
    weft_scenes_free(&comparison->scenes);
}
