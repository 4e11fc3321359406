#include "study/tradeoff/preset.h"

#include "base/text/json_text.h"
#include "btf/material/metadata.h"
#include "compress/compress.h"
#include "study/hold_out/record.h"
#include "study/tradeoff/frame_timer.h"
#include "study/tradeoff/held_error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ERROR_SIDE = 24, SURFACE_SIDE = 32, SIZE_SIDE = 32, SPLIT = 1 /* the measurement begins with 0 */ };

/* ---- The models ---- */

typedef struct choosing {
    weft_dataset *dataset;
    const weft_preset_wish *wish;
    const weft_compress_options *given;
    const char *scratch_path;
    const weft_progress *progress;
    weft_frame_timer *timer;
    int count, asked;
    weft_priced_model model[WEFT_PRICED_MOST];
    weft_offer offer[WEFT_PRICED_MOST];
    weft_preset_prediction prediction[WEFT_PRICED_MOST]; /* of those that were asked for it */
} choosing;

/* What is chosen of the options; all else is as it was given. */
static weft_compress_options merge(const weft_compress_options *given, const weft_compress_options *chosen)
{
    weft_compress_options merged = *given;
    merged.lobe_count = chosen->lobe_count;
    merged.table = chosen->table;
    merged.light_table = chosen->light_table;
    merged.frames = chosen->frames;
    merged.layer_count = chosen->layer_count;
    merged.heights = chosen->heights;
    merged.table_components = chosen->table_components;
    return merged;
}

static void list_models(choosing *work)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    weft_priced_dataset parts = weft_priced_dataset_of(work->dataset);
    parts.has_surface = parts.has_surface && work->given->heights;
    int count = weft_priced_models_list(layout, &parts, work->model);
    for (int i = 0; i < count; i++) {
        if (!work->model[i].arguments[0] || work->model[i].options.light_table)
            continue;
        work->model[work->count] = work->model[i];
        work->model[work->count].options = merge(work->given, &work->model[i].options);
        work->model[work->count++].options.checkpoint_path = NULL;
    }
}

/* ---- Errors ---- */

static weft_code measure_models(choosing *work, weft_held_bench *bench, weft_error *error)
{
    static const char step[] = "trying models";
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    for (int i = 0; i < work->count; i++) {
        weft_held_error measured;
        weft_progress_report(work->progress, step, i, work->count);
        WEFT_TRY(weft_held_bench_measure(bench, &work->model[i], &measured, error));
        double error_of = measured.held[WEFT_SAMPLES_ALL].relative_rmse;
        bool through = work->model[i].options.heights;
        work->offer[i] =
            (weft_offer){weft_weight_scaled(&measured.weight, layout->width, layout->height, work->given->levels),
                         error_of, !through || weft_priced_heights_are_kept(work->offer[i - 1].error, error_of)};
        weft_held_error_free(&measured);
    }
    weft_progress_report(work->progress, step, work->count, work->count);
    return WEFT_OK;
}

/* Near lights need texels at even distances; the model for few images needs neighbours, and so does a surface. */
static weft_excerpt_kind choose_texels(const choosing *work)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    int lobes;
    if (weft_compress_plan(layout, work->given, &lobes) == WEFT_COMPRESS_SPARSE ||
        weft_dataset_has_surface(work->dataset))
        return WEFT_EXCERPT_BLOCK;
    return layout->distance == WEFT_NEAR ? WEFT_EXCERPT_REGULAR : WEFT_EXCERPT_SCATTERED;
}

/* In the middle of a block where the dataset has a surface: there they are to be like what is measured afterwards. */
static int choose_side(const weft_dataset *dataset)
{
    return weft_dataset_has_surface(dataset) ? SURFACE_SIDE : ERROR_SIDE;
}

static weft_code measure(choosing *work, weft_error *error)
{
    weft_held_bench *bench;
    WEFT_TRY(weft_held_bench_create(work->dataset, choose_texels(work), choose_side(work->dataset), SPLIT,
                                    work->scratch_path, &bench, error));
    weft_code code = measure_models(work, bench, error);
    weft_held_bench_free(bench);
    return code;
}

/* ---- The size ---- */

/* With numbers of the length that they usually have; five levels are what 24 x 24 texels of a usual dataset give. */
static weft_certificate usual_certificate(void)
{
    weft_certificate c = {.probability = 0.95,
                          .over_images = true,
                          .image_count = 1232,
                          .direction_count = 16,
                          .mean = 0.062589012086391449,
                          .value = {0.012, 0.064, 0.135, 0.301, 0.572, 0.928, 1.527, 4.461},
                          .spread = {0.091, 0.047, 0.103, 0.239, 0.324, 0.362, 0.647, 1.664},
                          .level_count = 5};
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        c.view[ring] = c.light[ring] = 1.001;
        c.view_images[ring] = c.light_images[ring] = 100;
    }
    for (int k = 0; k < c.level_count; k++) {
        c.level[k].quantile = 1.001;
        for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
            c.level[k].fitted[ring] = 0.901;
            c.level[k].storage[ring] = 0.045;
        }
    }
    return c;
}

/* What is measured afterwards, with numbers of full length. */
static weft_hold_out usual_hold_out(bool has_surface, bool heights)
{
    const double number = 0.12345678901234567;
    const weft_error_summary summary = {number, number, number, number, 10 + number, 1000000};
    const weft_hold_out_error errors = {summary, summary, summary, summary};
    return (weft_hold_out){.split_count = 1,
                           .view_count = 81,
                           .view_held_count = 8,
                           .light_count = 81,
                           .light_held_count = 8,
                           .image_count = 6561,
                           .image_held_count = 1232,
                           .texel_count = 144,
                           .dataset_texel_count = 4096,
                           .material = errors,
                           .heights = {heights, heights, number, number},
                           .photographs = errors,
                           .photographs_flat = has_surface ? number : 0,
                           .fitted = summary,
                           .has_certificate = true,
                           .certificate = usual_certificate()};
}

/* What the file will say, so that it is weighed as it is stored. */
static weft_code complete_metadata(const choosing *work, const weft_compress_options *options,
                                   const weft_preset_prediction *prediction, weft_material *material, weft_error *error)
{
    const weft_priced_dataset parts = weft_priced_dataset_of(work->dataset);
    const weft_hold_out held_out = usual_hold_out(parts.has_surface, options->heights);
    const char *provenance = weft_dataset_get_layout(work->dataset)->provenance;
    WEFT_TRY(weft_material_put_metadata(material, "provenance", json_loads(provenance, 0, NULL), error));
    WEFT_TRY(weft_hold_out_store(&held_out, material, error));
    return weft_material_put_metadata(material, "predicted", weft_preset_to_json(prediction), error);
}

/* What nobody asked for is no reason to fail. */
static weft_code time_frame(const choosing *work, const weft_material *material, double *frame_ms, weft_error *error)
{
    weft_error ignored;
    bool must = work->wish->least_fps > 0;
    *frame_ms = 0;
    if (!work->timer)
        return WEFT_OK;
    weft_code code = weft_frame_timer_of_material(work->timer, material, frame_ms, must ? error : &ignored);
    return must ? code : WEFT_OK;
}

/* What it weighs, and how long a frame of it takes. The metadata are those of the whole dataset, not of the block. */
static weft_code fit_block(const choosing *work, const weft_compress_options *options,
                           weft_preset_prediction *prediction, weft_weight *weight, weft_error *error)
{
    weft_excerpt excerpt;
    weft_dataset *block;
    weft_material material;
    WEFT_TRY(weft_excerpt_read(work->dataset, WEFT_EXCERPT_BLOCK, SIZE_SIDE, &excerpt, error));
    uint8_t *none = calloc((size_t)excerpt.layout.image_count, 1);
    weft_code code = none ? weft_excerpt_write_with_surface(&excerpt, none, work->scratch_path, &block, error)
                          : weft_fail_memory(error, "images", (size_t)excerpt.layout.image_count);
    free(none);
    weft_excerpt_free(&excerpt);
    WEFT_TRY(code);
    code = weft_compress(block, options, NULL, &material, NULL, error);
    weft_dataset_close(block);
    WEFT_TRY(code);
    code = complete_metadata(work, options, prediction, &material, error);
    if (code == WEFT_OK)
        code = weft_weight_of(&material, weight, error);
    if (code == WEFT_OK)
        code = time_frame(work, &material, &prediction->frame_ms, error);
    weft_material_free(&material);
    return code;
}

static weft_code predict_costs(const choosing *work, const weft_compress_options *options,
                               weft_preset_prediction *prediction, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    weft_weight weight;
    WEFT_TRY(fit_block(work, options, prediction, &weight, error));
    prediction->bytes = weft_weight_scaled(&weight, layout->width, layout->height, options->levels);
    return WEFT_OK;
}

/* ---- The whole ---- */

/* Predicts all of a model; its frame is what was asked for. */
static weft_code predict(void *context, size_t which, double *frame_ms, weft_error *error)
{
    choosing *work = context;
    const weft_priced_model *model = &work->model[which];
    weft_preset_prediction *prediction = &work->prediction[which];
    *prediction = (weft_preset_prediction){.wish = *work->wish, .error = work->offer[which].error};
    memcpy(prediction->model, model->name, sizeof prediction->model);
    memcpy(prediction->arguments, model->arguments, sizeof prediction->arguments);
    weft_progress_report(work->progress, "sizing models", work->asked, work->count);
    WEFT_TRY(predict_costs(work, &model->options, prediction, error));
    weft_progress_report(work->progress, "sizing models", ++work->asked, work->count);
    *frame_ms = prediction->frame_ms;
    return WEFT_OK;
}

static weft_code fail_too_slow(const weft_preset_prediction *fastest, weft_error *error)
{
    return weft_fail(error, WEFT_BAD_USAGE,
                     "no model that a preset may choose is drawn at %g frames/s here: the fastest, %s, takes %.1f ms a "
                     "frame (%.0f frames/s)",
                     fastest->wish.least_fps, fastest->model, fastest->frame_ms, 1000 / fastest->frame_ms);
}

static weft_code choose(choosing *work, weft_compress_options *options, weft_preset_prediction *prediction,
                        weft_error *error)
{
    const weft_preset_wish *wish = work->wish;
    size_t chosen, fastest, count = (size_t)work->count;
    WEFT_TRY(weft_preset_choose_fast(work->offer, count, wish->preset,
                                     wish->least_fps > 0 ? 1000 / wish->least_fps : INFINITY, predict, work, &chosen,
                                     &fastest, error));
    if (chosen == count && fastest == count)
        return weft_fail(error, WEFT_BAD_USAGE, "no model can be chosen: none has an error on what was held out");
    if (chosen == count)
        return fail_too_slow(&work->prediction[fastest], error);
    *prediction = work->prediction[chosen];
    *options = merge(options, &work->model[chosen].options);
    return WEFT_OK;
}

static weft_code open_timer(choosing *work, weft_error *error)
{
    weft_error ignored;
    bool must = work->wish->least_fps > 0;
    if (!must && !work->wish->times_frames)
        return WEFT_OK;
    weft_code code = weft_frame_timer_open(&work->timer, must ? error : &ignored);
    if (must && code == WEFT_OK && weft_frame_timer_why_not(work->timer)[0])
        return weft_fail(error, WEFT_SYSTEM, "frames cannot be timed: %s", weft_frame_timer_why_not(work->timer));
    return must ? code : WEFT_OK;
}

static weft_code work_through(choosing *work, weft_compress_options *options, weft_preset_prediction *prediction,
                              weft_error *error)
{
    WEFT_TRY(open_timer(work, error));
    list_models(work);
    WEFT_TRY(measure(work, error));
    return choose(work, options, prediction, error);
}

weft_code weft_preset_predict(weft_dataset *dataset, const weft_preset_wish *wish, const char *scratch_path,
                              const weft_progress *progress, weft_compress_options *options,
                              weft_preset_prediction *prediction, weft_error *error)
{
    choosing *work = calloc(1, sizeof *work);
    if (!work)
        return weft_fail_memory(error, "models", sizeof *work);
    const weft_compress_options given = *options;
    work->dataset = dataset;
    work->wish = wish;
    work->given = &given;
    work->scratch_path = scratch_path;
    work->progress = progress;
    weft_code code = work_through(work, options, prediction, error);
    weft_frame_timer_close(work->timer);
    free(work);
    return code;
}

/* The time of a frame is not the same twice: it is there only where it was asked for, and equal files are equal. */
json_t *weft_preset_to_json(const weft_preset_prediction *prediction)
{
    json_t *object = json_pack("{s:s, s:s, s:s, s:f, s:f}", "preset", weft_preset_name(prediction->wish.preset),
                               "model", prediction->model, "options", prediction->arguments, "bytes", prediction->bytes,
                               "relative_rmse", prediction->error);
    if (!object || !(prediction->wish.least_fps > 0))
        return object;
    json_t *speed = json_pack("{s:f, s:f}", "least_fps", prediction->wish.least_fps, "frame_ms", prediction->frame_ms);
    int outcome = speed ? json_object_update(object, speed) : -1;
    json_decref(speed);
    if (outcome == 0)
        return object;
    json_decref(object);
    return NULL;
}

json_t *weft_preset_to_event(const weft_preset_prediction *prediction)
{
    json_t *object = weft_preset_to_json(prediction);
    if (object && prediction->frame_ms > 0)
        weft_json_put(&object, "frame_ms", json_real(prediction->frame_ms));
    return object;
}
