#include "compare/report/compare.h"

#include "btf/dataset/dataset.h"
#include "compress/compress.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- Which photographs ---- */

/* The photograph's file, where the provenance lists it. */
static void name_photograph(const json_t *provenance, int image, char name[64])
{
    const char *file = json_string_value(json_array_get(json_object_get(provenance, "photographs"), (size_t)image));
    if (file)
        snprintf(name, 64, "%s", file);
    else
        snprintf(name, 64, "image %d", image);
}

/* ---- One photograph ---- */

/* Fills a pair from the dataset, a band of rows at a time. */
static weft_code read_pair(weft_dataset *dataset, weft_predictor *predictor, weft_image_pair *pair, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    int band = weft_dataset_rows_at_once(layout);
    size_t most = (size_t)band * (size_t)layout->width * (size_t)layout->image_count;
    weft_half *samples = malloc(3 * most * sizeof *samples);
    uint8_t *mask = malloc(most);
    weft_code code = samples && mask ? WEFT_OK : weft_fail_memory(error, "rows of texels", 7 * most);
    for (int y = 0; y < layout->height && code == WEFT_OK; y += band) {
        int rows = band < layout->height - y ? band : layout->height - y;
        code = weft_dataset_read_block(dataset, 0, y, layout->width, rows, samples, mask, error);
        if (code == WEFT_OK)
            code = weft_predictor_prepare_rows(predictor, y, rows, error);
        if (code == WEFT_OK)
            weft_image_pair_fill(pair, layout, predictor, y, rows, samples, mask);
    }
    free(samples);
    free(mask);
    return code;
}

static weft_code predict(weft_dataset *dataset, const weft_material *material, weft_left_out *photograph,
                         weft_error *error)
{
    weft_predictor *predictor;
    WEFT_TRY(weft_predictor_of_material(weft_dataset_get_layout(dataset), material, &predictor, error));
    weft_code code = read_pair(dataset, predictor, &photograph->pair, error);
    weft_predictor_free(predictor);
    return code == WEFT_OK ? weft_image_pair_error(&photograph->pair, &photograph->error, error) : code;
}

static weft_code leave_out(weft_dataset *dataset, int image, uint8_t *held_out, weft_left_out *photograph,
                           double *seconds, weft_error *error)
{
    weft_compress_options options = weft_compress_default_options();
    options.levels = false;
    options.held_out = held_out;
    weft_material material;
    weft_compress_report report;
    held_out[image] = 1;
    weft_code code = weft_compress(dataset, &options, NULL, &material, &report, error);
    held_out[image] = 0;
    WEFT_TRY(code);
    *seconds += report.seconds;
    code = predict(dataset, &material, photograph, error);
    weft_material_free(&material);
    return code;
}

/* ---- All of them ---- */

static weft_code leave_out_each(weft_dataset *dataset, uint8_t *held_out, const json_t *provenance,
                                const weft_progress *progress, weft_leave_one_out *result, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    weft_progress_report(progress, "leaving photographs out", 0, layout->image_count);
    for (int image = 0; image < layout->image_count; image++) {
        weft_left_out *photograph = &result->photograph[result->count];
        WEFT_TRY(weft_image_pair_create(layout, image, &photograph->pair, error));
        WEFT_TRY(leave_out(dataset, image, held_out, photograph, &result->seconds, error));
        name_photograph(provenance, image, photograph->name);
        if (photograph->error.count > 0)
            result->count++;
        else
            weft_image_pair_free(&photograph->pair);
        weft_progress_report(progress, "leaving photographs out", image + 1, layout->image_count);
    }
    return WEFT_OK;
}

static void average(weft_leave_one_out *result)
{
    for (int i = 0; i < result->count; i++) {
        result->mean_relative_rmse += result->photograph[i].error.relative_rmse / result->count;
        result->mean_median_relative += result->photograph[i].error.median_relative / result->count;
    }
}

weft_code weft_leave_one_out_measure(weft_dataset *dataset, const weft_progress *progress, weft_leave_one_out *result,
                                     weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    size_t count = (size_t)layout->image_count;
    *result = (weft_leave_one_out){.photograph = calloc(count, sizeof(weft_left_out)), .capacity = layout->image_count};
    uint8_t *held_out = calloc(count, 1);
    json_t *provenance = json_loads(layout->provenance, 0, NULL);
    weft_code code = WEFT_OK;
    if (!result->photograph || !held_out || !provenance)
        code = weft_fail_memory(error, "photographs", count * sizeof(weft_left_out));
    else
        code = leave_out_each(dataset, held_out, provenance, progress, result, error);
    json_decref(provenance);
    free(held_out);
    if (code != WEFT_OK)
        weft_leave_one_out_free(result);
    else
        average(result);
    return code;
}

void weft_leave_one_out_free(weft_leave_one_out *result)
{
    for (int i = 0; result->photograph && i < result->capacity; i++)
        weft_image_pair_free(&result->photograph[i].pair);
    free(result->photograph);
    *result = (weft_leave_one_out){0};
}
