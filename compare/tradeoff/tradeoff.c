#include "compare/tradeoff/tradeoff.h"

#include "base/atomic_file.h"
#include "base/clock.h"
#include "btf/material/components.h"
#include "compare/tradeoff/cloth.h"
#include "compress/hold_out/measured_texels.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PICTURE_SIDE = 32, PRICED_SIDE = 64 };

/* Texels that lie spread are other ones for components, which need more of them. */
enum { TEXELS_OF_LOBES, TEXELS_OF_COMPONENTS, TEXELS_OF_END };

/* The study at work. */
typedef struct studying {
    weft_dataset *dataset;
    const char *cloth;
    char *scratch_path;
    weft_held_bench *pictures;              /* neighbours */
    weft_held_bench *spread[TEXELS_OF_END]; /* NULL where errors are of neighbours, too */
    weft_price_shop *shop;
    const weft_progress *progress;
    int work_done, work_total;
    weft_tradeoff *result;
} studying;

/* ---- Rows ---- */

/* NULL: the model needs neighbours. */
static weft_held_bench *spread_bench_of(const studying *work, const weft_priced_model *model)
{
    if (model->family == WEFT_PRICED_CLOTH)
        return NULL;
    return work->spread[weft_priced_model_is_of_lobes(model) ? TEXELS_OF_LOBES : TEXELS_OF_COMPONENTS];
}

/* Pictures are of neighbours, and where no texels lie spread errors are, too. */
static weft_code measure_model(const studying *work, weft_tradeoff_row *row, weft_error *error)
{
    weft_held_error spread;
    weft_held_bench *bench = spread_bench_of(work, &row->model);
    row->is_of_neighbours = !bench;
    if (!bench)
        return weft_held_bench_measure(work->pictures, &row->model, &row->measured, error);
    WEFT_TRY(weft_held_bench_picture(work->pictures, &row->model, &row->measured, error));
    weft_code code = weft_held_bench_measure(bench, &row->model, &spread, error);
    if (code != WEFT_OK) {
        weft_held_error_free(&row->measured);
        return code;
    }
    memcpy(row->measured.held, spread.held, sizeof spread.held);
    memcpy(row->measured.fitted, spread.fitted, sizeof spread.fitted);
    row->measured.interval_width = spread.interval_width;
    weft_held_error_free(&spread);
    return WEFT_OK;
}

static weft_code study_model(studying *work, const weft_priced_model *model, weft_error *error)
{
    weft_tradeoff_row *row = &work->result->row[work->result->row_count];
    *row = (weft_tradeoff_row){.model = *model};
    WEFT_TRY(weft_price_ask(work->shop, model, &row->price, error));
    WEFT_TRY(measure_model(work, row, error));
    work->result->row_count++;
    return WEFT_OK;
}

static weft_code study_models(studying *work, weft_error *error)
{
    weft_priced_model model[WEFT_PRICED_MOST];
    weft_priced_dataset parts = weft_priced_dataset_of(work->dataset);
    parts.cloth = work->cloth;
    int count = weft_priced_models_list(weft_dataset_get_layout(work->dataset), &parts, model);
    for (int i = 0; i < count; i++)
        work->work_total += model[i].work;
    for (int i = 0; i < count; i++) {
        weft_progress_report(work->progress, "fitting models", work->work_done, work->work_total);
        WEFT_TRY(study_model(work, &model[i], error));
        work->work_done += model[i].work;
    }
    weft_progress_report(work->progress, "fitting models", work->work_done, work->work_total);
    return WEFT_OK;
}

/* ---- Choices ---- */

static double error_of(const weft_tradeoff_row *row)
{
    return row->measured.held[WEFT_SAMPLES_ALL].relative_rmse;
}

/* A row through heights comes right after the same without. */
static bool may_be_chosen(const weft_tradeoff_row *row)
{
    bool is_through = row->model.family == WEFT_PRICED_COMPONENTS && row->model.options.heights;
    return row->model.arguments[0] && (!is_through || weft_priced_heights_are_kept(error_of(row - 1), error_of(row)));
}

static void choose(weft_tradeoff *result)
{
    weft_offer offer[WEFT_PRICED_MOST];
    size_t count = (size_t)result->row_count;
    for (size_t i = 0; i < count; i++) {
        const weft_tradeoff_row *row = &result->row[i];
        offer[i] = (weft_offer){row->price.bytes, error_of(row), may_be_chosen(row)};
    }
    for (size_t i = 0; i < count; i++)
        result->row[i].is_beaten = weft_offer_is_beaten(offer, count, i);
    for (weft_preset preset = WEFT_PRESET_SMALL; preset < WEFT_PRESET_COUNT; preset++) {
        size_t chosen = weft_preset_choose(offer, count, preset);
        if (chosen < count)
            result->row[chosen].is_chosen[preset] = result->row[chosen].is_chosen[WEFT_PRESET_NONE] = true;
    }
}

/* ---- The whole ---- */

static long texels_of(const studying *work, int which)
{
    return weft_held_bench_texels(work->spread[which] ? work->spread[which] : work->pictures);
}

static void describe(studying *work)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    const weft_splits *splits = weft_held_bench_splits(work->pictures);
    weft_tradeoff *result = work->result;
    result->width = layout->width;
    result->height = layout->height;
    result->image_count = layout->image_count;
    result->view_count = layout->view_count;
    result->kind = splits->kind;
    result->view_held_count = splits->view_held_count;
    result->light_held_count = splits->light_held_count;
    result->light_count = splits->light_count;
    for (int i = 0; i < splits->image_count; i++)
        result->image_held_count += weft_splits_held(splits, 0)[i] != 0;
    result->neighbours = weft_held_bench_texels(work->pictures);
    result->measured_texels = texels_of(work, TEXELS_OF_COMPONENTS);
    result->lobe_texels = texels_of(work, TEXELS_OF_LOBES);
    result->fitted_texels = weft_price_shop_texels(work->shop);
    result->texels = (long)layout->width * layout->height;
    result->threads = omp_get_max_threads();
    snprintf(result->why_not_drawn, sizeof result->why_not_drawn, "%s", weft_price_shop_why_not_drawn(work->shop));
    snprintf(result->renderer, sizeof result->renderer, "%s", weft_price_shop_renderer(work->shop));
}

/* What cannot be read is said before the work. */
static weft_code check_cloth(const char *path, weft_error *error)
{
    weft_priced_cloth cloth = {0};
    weft_code code = path ? weft_priced_cloth_open(path, &cloth, error) : WEFT_OK;
    weft_priced_cloth_free(&cloth);
    return code;
}

/* The texels and splits by which a material's own error is measured, where they lie spread. */
static weft_code open_spread_bench(studying *work, int which, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    weft_compress_options options = weft_compress_default_options();
    options.component_count = which == TEXELS_OF_COMPONENTS ? WEFT_COMPONENTS_GROUP : 0;
    if (!weft_measures_spread_texels(work->dataset, &options, weft_held_bench_splits(work->pictures)))
        return WEFT_OK;
    return weft_held_bench_create(
        work->dataset, WEFT_TEXEL_SUBSET_SCATTERED, weft_measured_texels_spread_side(layout, &options),
        (weft_splits_asked){0, work->result->split_count}, work->scratch_path, &work->spread[which], error);
}

static weft_code open_benches(studying *work, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    WEFT_TRY(weft_held_bench_create(work->dataset, WEFT_TEXEL_SUBSET_BLOCK, PICTURE_SIDE, (weft_splits_asked){0, 1},
                                    work->scratch_path, &work->pictures, error));
    WEFT_TRY(weft_hold_out_enough_splits(layout, &work->result->split_count, error));
    for (int which = 0; which < TEXELS_OF_END; which++)
        WEFT_TRY(open_spread_bench(work, which, error));
    return WEFT_OK;
}

static weft_code study(studying *work, const char *dataset_path, const char *folder, weft_error *error)
{
    WEFT_TRY(check_cloth(work->cloth, error));
    WEFT_TRY(weft_dataset_open(dataset_path, &work->dataset, error));
    WEFT_TRY(weft_make_folder(folder, error));
    if (asprintf(&work->scratch_path, "%s/tradeoff.btf.h5", folder) < 0) {
        work->scratch_path = NULL;
        return weft_fail_memory(error, "path", strlen(folder));
    }
    WEFT_TRY(open_benches(work, error));
    WEFT_TRY(weft_price_shop_open(work->dataset, PRICED_SIDE, work->scratch_path, work->progress, &work->shop, error));
    describe(work);
    WEFT_TRY(study_models(work, error));
    choose(work->result);
    return WEFT_OK;
}

static weft_code write_results(const weft_tradeoff *result, const char *dataset_path, const char *folder,
                               weft_error *error)
{
    char *path;
    if (asprintf(&path, "%s/tradeoff.csv", folder) < 0)
        return weft_fail_memory(error, "path", strlen(folder));
    weft_code code = weft_tradeoff_write_csv(result, path, error);
    free(path);
    return code == WEFT_OK ? weft_tradeoff_write_page(result, dataset_path, folder, error) : code;
}

weft_code weft_tradeoff_study(const char *dataset_path, const char *cloth, const char *folder,
                              const weft_progress *progress, weft_tradeoff *result, weft_error *error)
{
    studying work = {.cloth = cloth, .progress = progress, .result = result};
    double began = weft_now_s();
    *result = (weft_tradeoff){0};
    weft_code code = study(&work, dataset_path, folder, error);
    weft_price_shop_close(work.shop);
    weft_held_bench_free(work.pictures);
    for (int which = 0; which < TEXELS_OF_END; which++)
        weft_held_bench_free(work.spread[which]);
    weft_dataset_close(work.dataset);
    free(work.scratch_path);
    result->seconds = weft_now_s() - began;
    if (code == WEFT_OK)
        code = write_results(result, dataset_path, folder, error);
    if (code != WEFT_OK)
        weft_tradeoff_free(result);
    return code;
}

void weft_tradeoff_free(weft_tradeoff *tradeoff)
{
    for (int i = 0; i < tradeoff->row_count; i++)
        weft_held_error_free(&tradeoff->row[i].measured);
    *tradeoff = (weft_tradeoff){0};
}
