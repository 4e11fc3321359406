#include "compare/tradeoff/prediction.h"

#include "compare/tradeoff/frame_timer.h"
#include "compare/tradeoff/held_error.h"
#include "compress/compress.h"
#include "compress/hold_out/hold_out.h"

#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ERROR_SIDE = 24, SURFACE_SIDE = 32 };

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
    weft_prediction prediction[WEFT_PRICED_MOST]; /* of those that were asked for it */
} choosing;

/* What is chosen of the options; all else is as it was given. */
static weft_compress_options merge(const weft_compress_options *given, const weft_compress_options *chosen)
{
    weft_compress_options merged = *given;
    merged.lobe_count = chosen->lobe_count;
    merged.component_count = chosen->component_count;
    merged.heights = chosen->heights;
    return merged;
}

static void list_models(choosing *work)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    weft_priced_dataset parts = weft_priced_dataset_of(work->dataset);
    parts.has_surface = parts.has_surface && work->given->heights;
    int count = weft_priced_models_list(layout, &parts, work->model);
    for (int i = 0; i < count; i++) {
        if (!work->model[i].arguments[0])
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
        bool through = i > 0 && work->model[i].options.heights;
        work->offer[i] =
            (weft_offer){weft_weight_scaled(&measured.weight, layout->width, layout->height, work->given->levels),
                         error_of, !through || weft_priced_heights_are_kept(work->offer[i - 1].error, error_of)};
        weft_held_error_free(&measured);
    }
    weft_progress_report(work->progress, step, work->count, work->count);
    return WEFT_OK;
}

/* Near lights need texels at even distances; the model for few images needs neighbours, and so does a surface. */
static weft_texel_subset_kind choose_texels(const choosing *work)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    int lobes;
    if (weft_compress_plan(layout, work->given, &lobes) == WEFT_COMPRESS_SPARSE ||
        weft_dataset_has_surface(work->dataset))
        return WEFT_TEXEL_SUBSET_BLOCK;
    return layout->distance == WEFT_NEAR ? WEFT_TEXEL_SUBSET_REGULAR : WEFT_TEXEL_SUBSET_SCATTERED;
}

/* In the middle of a block where the dataset has a surface: there they are to be like what is measured afterwards. */
static int choose_side(const weft_dataset *dataset)
{
    return weft_dataset_has_surface(dataset) ? SURFACE_SIDE : ERROR_SIDE;
}

static weft_code measure(choosing *work, weft_error *error)
{
    weft_held_bench *bench;
    int splits;
    WEFT_TRY(weft_hold_out_enough_splits(weft_dataset_get_layout(work->dataset), &splits, error));
    int measured = work->wish->measured_splits > 0 ? work->wish->measured_splits : splits; /* from 0 on */
    WEFT_TRY(weft_held_bench_create(work->dataset, choose_texels(work), choose_side(work->dataset),
                                    (weft_splits_asked){(uint64_t)measured, splits}, work->scratch_path, &bench,
                                    error));
    weft_code code = measure_models(work, bench, error);
    weft_held_bench_free(bench);
    return code;
}

/* ---- The whole ---- */

/* Predicts all of a model; its frame is what was asked for. */
static weft_code predict(void *context, size_t which, double *frame_ms, weft_error *error)
{
    choosing *work = context;
    const weft_priced_model *model = &work->model[which];
    weft_prediction *prediction = &work->prediction[which];
    *prediction = (weft_prediction){
        .preset = work->wish->preset, .least_fps = work->wish->least_fps, .error = work->offer[which].error};
    memcpy(prediction->model, model->name, sizeof prediction->model);
    memcpy(prediction->arguments, model->arguments, sizeof prediction->arguments);
    weft_progress_report(work->progress, "sizing models", work->asked, work->count);
    WEFT_TRY(
        weft_prediction_find_costs(work->dataset, &model->options, work->scratch_path, work->timer, prediction, error));
    weft_progress_report(work->progress, "sizing models", ++work->asked, work->count);
    *frame_ms = prediction->frame_ms;
    return WEFT_OK;
}

static weft_code fail_too_slow(const weft_prediction *fastest, weft_error *error)
{
    return weft_fail(error, WEFT_BAD_USAGE,
                     "no model that a preset may choose is drawn at %g frames/s here: the fastest, %s, takes %.1f ms a "
                     "frame (%.0f frames/s)",
                     fastest->least_fps, fastest->model, fastest->frame_ms, 1000 / fastest->frame_ms);
}

static weft_code choose(choosing *work, weft_compress_options *options, weft_prediction *prediction, weft_error *error)
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

static weft_code work_through(choosing *work, weft_compress_options *options, weft_prediction *prediction,
                              weft_error *error)
{
    WEFT_TRY(open_timer(work, error));
    list_models(work);
    WEFT_TRY(measure(work, error));
    return choose(work, options, prediction, error);
}

weft_code weft_preset_predict(weft_dataset *dataset, const weft_preset_wish *wish, const char *scratch_path,
                              const weft_progress *progress, weft_compress_options *options,
                              weft_prediction *prediction, weft_error *error)
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
    malloc_trim(0); /* what is kept would count against the memory that the fit may take */
    return code;
}
