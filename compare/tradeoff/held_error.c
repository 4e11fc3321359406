#include "compare/tradeoff/held_error.h"

#include "base/integers.h"
#include "compare/tradeoff/cloth.h"
#include "compress/bard/predict.h"
#include "compress/compress.h"
#include "compress/hold_out/certify.h"
#include "compress/hold_out/hold_out.h"
#include "compress/hold_out/measured_texels.h"
#include "evaluate/error/coverage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_SPLITS = WEFT_HOLD_OUT_ENOUGH /* also of a handful of images, each held out in turn */ };

static const size_t enough_residuals = 1 << 20;
static const double certified = 0.95;

struct weft_held_bench {
    const weft_dataset *dataset;
    const char *scratch_path;
    weft_texel_subset subset;
    weft_texel_block asked;  /* of the subset, in its middle: less than all where it has a surface */
    weft_texel_subset alone; /* these, to which lobes are fitted where it has a surface; else nothing */
    weft_splits splits;
    int split_count; /* that are measured: the first ones */
    bool has_pictures;
    bool for_pictures_alone;     /* nothing but these is asked of the model at work */
    uint8_t *kinds;              /* [texel][image] bits 1 << weft_sample_kind */
    uint8_t *known[MOST_SPLITS]; /* [texel][image] by split: held out, and known through the surface of the subset, so
                                    that all models are asked for the same; NULL where there is none */
    bool is_fitted;              /* the materials below are, of this model */
    weft_priced_model fitted_model;
    double fit_s;
    weft_material material[MOST_SPLITS];
};

void weft_held_error_free(weft_held_error *measured)
{
    weft_image_free(&measured->sample);
    weft_image_free(&measured->predicted);
}

/* ---- The bench ---- */

static weft_code prepare(weft_dataset *dataset, weft_texel_subset_kind kind, int side, weft_splits_asked asked,
                         weft_held_bench *bench, weft_error *error)
{
    /* The one after the last is that of the fitted images. */
    WEFT_TRY(weft_splits_create(weft_dataset_get_layout(dataset), asked.first, asked.count + 1, &bench->splits, error));
    bench->split_count = bench->splits.kind == WEFT_SPLIT_EACH ? MOST_SPLITS : asked.count;
    bench->split_count = weft_smaller(bench->split_count, bench->splits.count);
    bool has_surface = weft_dataset_has_surface(dataset);
    int images = weft_dataset_get_layout(dataset)->image_count;
    WEFT_TRY(weft_texel_subset_read(dataset, kind, has_surface ? weft_hold_out_surface_side(images) : side,
                                    &bench->subset, error));
    bench->asked = weft_texel_subset_middle(&bench->subset, side);
    if (has_surface)
        WEFT_TRY(weft_texel_subset_crop(&bench->subset, &bench->asked, &bench->alone, error));
    return weft_sample_kinds_mark(&bench->subset, &bench->kinds, error);
}

weft_code weft_held_bench_create(weft_dataset *dataset, weft_texel_subset_kind kind, int side, weft_splits_asked asked,
                                 const char *scratch_path, weft_held_bench **result, weft_error *error)
{
    weft_held_bench *bench = calloc(1, sizeof *bench);
    if (!bench)
        return weft_fail_memory(error, "bench", sizeof *bench);
    bench->dataset = dataset;
    bench->scratch_path = scratch_path;
    bench->has_pictures = kind == WEFT_TEXEL_SUBSET_BLOCK;
    weft_code code = prepare(dataset, kind, side, asked, bench, error);
    if (code == WEFT_OK)
        *result = bench;
    else
        weft_held_bench_free(bench);
    return code;
}

static void forget_fit(weft_held_bench *bench)
{
    for (int s = 0; s < MOST_SPLITS; s++)
        weft_material_free(&bench->material[s]);
    bench->is_fitted = false;
}

void weft_held_bench_free(weft_held_bench *bench)
{
    if (!bench)
        return;
    forget_fit(bench);
    weft_texel_subset_free(&bench->subset);
    weft_texel_subset_free(&bench->alone);
    weft_splits_free(&bench->splits);
    free(bench->kinds);
    for (int s = 0; s < MOST_SPLITS; s++)
        free(bench->known[s]);
    free(bench);
}

long weft_held_bench_texels(const weft_held_bench *bench)
{
    return (long)bench->asked.width * bench->asked.height;
}

const weft_splits *weft_held_bench_splits(const weft_held_bench *bench)
{
    return &bench->splits;
}

/* ---- Fits ---- */

/* What is held out of a fit, beside what the model does without: [image_count] each. */
typedef struct split_masks {
    uint8_t *left_out; /* by the model */
    uint8_t *unseen;   /* by the model or by the split */
    uint8_t *next;     /* by the next split, but fitted here */
} split_masks;

static void free_masks(split_masks *masks)
{
    free(masks->left_out);
    free(masks->unseen);
    free(masks->next);
}

static weft_code make_masks(const weft_held_bench *bench, const weft_priced_model *model, int split, split_masks *masks,
                            weft_error *error)
{
    size_t images = (size_t)bench->subset.layout.image_count;
    const uint8_t *held = weft_splits_held(&bench->splits, split);
    const uint8_t *next = weft_splits_held(&bench->splits, (split + 1) % bench->splits.count);
    *masks = (split_masks){malloc(images), malloc(images), malloc(images)};
    if (!masks->left_out || !masks->unseen || !masks->next)
        return weft_fail_memory(error, "images", 3 * images);
    weft_photographs_leave_out(&bench->subset.layout, model->photographs, masks->left_out);
    for (size_t i = 0; i < images; i++) {
        masks->unseen[i] = held[i] || masks->left_out[i];
        masks->next[i] = masks->left_out[i] ? 0 : next[i];
    }
    return WEFT_OK;
}

/* Lobes and BARD need no neighbours. */
static bool is_fitted_alone(const weft_held_bench *bench, const weft_priced_model *model)
{
    return bench->alone.samples && model->options.component_count == 0 && model->family != WEFT_PRICED_CLOTH;
}

static const weft_texel_subset *fitted_subset(const weft_held_bench *bench, const weft_priced_model *model)
{
    return is_fitted_alone(bench, model) ? &bench->alone : &bench->subset;
}

static weft_code fit_split(weft_held_bench *bench, const weft_priced_model *model, int split, const uint8_t *unseen,
                           weft_error *error)
{
    weft_dataset *others;
    weft_compress_report report;
    weft_compress_options options = model->options;
    options.levels = bench->has_pictures && !bench->for_pictures_alone;
    options.heights = false; /* those of the whole dataset are given afterwards */
    WEFT_TRY(weft_texel_subset_write(fitted_subset(bench, model), unseen, bench->scratch_path, &others, error));
    weft_code code = weft_compress(others, &options, NULL, &bench->material[split], &report, error);
    weft_dataset_close(others);
    if (code != WEFT_OK)
        return code;
    bench->fit_s += report.seconds;
    return WEFT_OK;
}

/* ---- Errors ---- */

static weft_code summarise(const weft_held_bench *bench, const weft_asked_samples *asked,
                           weft_error_summary result[WEFT_SAMPLE_KINDS], weft_error *error)
{
    uint8_t *group = malloc(asked->count + 1);
    if (!group)
        return weft_fail_memory(error, "samples", asked->count);
    weft_code code = WEFT_OK;
    for (int kind = 0; kind < WEFT_SAMPLE_KINDS && code == WEFT_OK; kind++) {
        for (size_t i = 0; i < asked->count; i++)
            group[i] = bench->kinds[asked->sample[i]] >> kind & 1;
        code = weft_error_summary_of_group(asked->value, group, asked->count, 1, &result[kind], error);
    }
    free(group);
    return code;
}

/* Moves the values of `more` behind those of `all`. */
static weft_code append(weft_asked_samples *all, weft_asked_samples *more, weft_error *error)
{
    size_t count = all->count + more->count;
    weft_compared *value = realloc(all->value, (count + 1) * sizeof *value);
    all->value = value ? value : all->value;
    uint32_t *sample = realloc(all->sample, (count + 1) * sizeof *sample);
    all->sample = sample ? sample : all->sample;
    uint8_t *group = realloc(all->group, count + 1);
    all->group = group ? group : all->group;
    if (!value || !sample || !group)
        return weft_fail_memory(error, "samples", count * (sizeof *value + sizeof *sample));
    if (more->count > 0) {
        memcpy(value + all->count, more->value, more->count * sizeof *value);
        memcpy(sample + all->count, more->sample, more->count * sizeof *sample);
        memcpy(group + all->count, more->group, more->count);
    }
    all->count = count;
    return WEFT_OK;
}

/* ---- The interval ---- */

static weft_code cover(const weft_certificate *certificate, const weft_residuals *held, double *width,
                       weft_error *error)
{
    weft_covered *covered = malloc((held->count[0] + 1) * sizeof *covered);
    if (!covered)
        return weft_fail_memory(error, "samples", held->count[0] * sizeof *covered);
    for (size_t i = 0; i < held->count[0]; i++) {
        const weft_residual *r = &held->value[0][i];
        double scale = weft_certificate_scale_of_rings(certificate, (double)r->prediction, r->light, r->view);
        covered[i] = (weft_covered){{r->prediction + r->error, r->prediction},
                                    (float)(certificate->level[0].quantile * scale),
                                    r->view,
                                    r->light};
    }
    weft_coverage coverage;
    weft_code code = weft_coverage_of(covered, held->count[0], &coverage, error);
    free(covered);
    *width = code == WEFT_OK ? coverage.all.width : 0;
    return code;
}

/* Its width on the samples that it was found from. */
static weft_code find_interval(const weft_held_bench *bench, const weft_asked_samples *held, double *width,
                               weft_error *error)
{
    weft_residuals residuals = {0}, none = {0};
    weft_certificate certificate;
    bool found = false;
    *width = 0;
    const weft_residuals_taken taken = {.most = enough_residuals};
    weft_code code = weft_residuals_add(&residuals, &bench->subset, held, NULL, &taken, error);
    if (code == WEFT_OK)
        code = weft_certify(&residuals, &none, certified, 1, 1, &certificate, &found, error);
    if (code == WEFT_OK && found)
        code = cover(&certificate, &residuals, width, error);
    weft_residuals_free(&residuals);
    return code;
}

/* What is said of the images of one split, and of all splits before it. */
typedef struct said {
    weft_asked_samples held, fitted;
} said;

static void free_said(said *s)
{
    weft_asked_samples_free(&s->held);
    weft_asked_samples_free(&s->fitted);
}

/* The heights that the model is seen through, and what they add to its weight. */
static weft_code give_heights(const weft_held_bench *bench, const weft_priced_model *model, weft_material *material,
                              weft_weight *weight, weft_error *error)
{
    const weft_texel_subset *subset = &bench->subset;
    const weft_predicted_window *window = &subset->window;
    if (!model->options.heights || !weft_texel_subset_has_surface(subset) || !material->components)
        return WEFT_OK;
    WEFT_TRY(weft_texel_subset_give_heights(subset, material, error));
    double share =
        (double)subset->layout.width * subset->layout.height / ((double)window->whole_width * window->whole_height);
    weight->by_texels += share * (double)weft_material_heights_size(material->heights);
    return WEFT_OK;
}

static weft_code ask_material(weft_held_bench *bench, const weft_priced_model *model, int split,
                              const weft_trial *trial, said *answer, weft_weight *weight, weft_error *error)
{
    const weft_texel_subset *fitted = fitted_subset(bench, model);
    weft_material *material = &bench->material[split];
    weft_predictor *predictor;
    WEFT_TRY(weft_weight_of(material, weight, error));
    weft_code code = give_heights(bench, model, material, weight, error);
    if (code == WEFT_OK)
        code = weft_predictor_of_window(&fitted->layout, &fitted->window, material, &predictor, error);
    if (code == WEFT_OK) {
        code = weft_trial_ask(trial, predictor, &answer->held, &answer->fitted, error);
        weft_predictor_free(predictor);
    }
    weft_material_take_heights(material, NULL);
    return code;
}

/* What the fitted images say of all. */
static weft_code predict_texels(const weft_priced_model *model, const weft_texel_subset *subset, const uint8_t *unseen,
                                weft_half *predicted, weft_error *error)
{
    const weft_dataset_layout *layout = &subset->layout;
    const weft_bard_options options = weft_bard_defaults();
    long texels = (long)layout->width * layout->height;
    return model->family == WEFT_PRICED_BARD ? weft_bard_predict_texels(layout, unseen, &options, subset->samples,
                                                                        subset->mask, texels, predicted, error)
                                             : weft_rti_predict_texels(layout, unseen, model->rti, subset->samples,
                                                                       subset->mask, texels, predicted, error);
}

static weft_code ask_bard_or_rti(const weft_held_bench *bench, const weft_priced_model *model, const weft_trial *trial,
                                 const uint8_t *unseen, said *answer, weft_error *error)
{
    const weft_texel_subset *subset = fitted_subset(bench, model);
    const weft_dataset_layout *layout = &subset->layout;
    size_t values = 3 * (size_t)layout->width * (size_t)layout->height * (size_t)layout->image_count;
    weft_half *predicted = malloc(values * sizeof *predicted);
    weft_predictor *predictor;
    if (!predicted)
        return weft_fail_memory(error, "predictions", values * sizeof *predicted);
    weft_code code = predict_texels(model, subset, unseen, predicted, error);
    if (code != WEFT_OK) {
        free(predicted);
        return code;
    }
    WEFT_TRY(weft_predictor_of_samples(layout, predicted, &predictor, error));
    code = weft_trial_ask(trial, predictor, &answer->held, &answer->fitted, error);
    weft_predictor_free(predictor);
    return code;
}

/* The photographs as the matrices restore them, interpolated. */
static weft_code ask_factorised(const weft_priced_model *model, const weft_trial *trial, const uint8_t *unseen,
                                said *answer, weft_error *error)
{
    const weft_texel_subset *subset = trial->subset;
    const weft_dataset_layout *layout = &subset->layout;
    size_t bytes = 3 * (size_t)layout->width * (size_t)layout->height * (size_t)layout->image_count * sizeof(weft_half);
    weft_texel_subset restored = *subset;
    weft_trial of_restored = *trial;
    of_restored.subset = &restored;
    restored.samples = malloc(bytes);
    if (!restored.samples)
        return weft_fail_memory(error, "samples", bytes);
    memcpy(restored.samples, subset->samples, bytes);
    weft_code code = weft_factorised_restore(model->factorised, subset, unseen, restored.samples, error);
    if (code == WEFT_OK)
        code = weft_trial_ask_photographs(&of_restored, false, &answer->held, error);
    free(restored.samples);
    return code;
}

static weft_code ask_fitted_cloth(weft_held_bench *bench, const weft_trial *trial, const uint8_t *unseen,
                                  weft_priced_cloth *cloth, said *answer, weft_error *error)
{
    weft_dataset *others;
    weft_predictor *predictor;
    WEFT_TRY(weft_texel_subset_write(&bench->subset, unseen, bench->scratch_path, &others, error));
    weft_code code = weft_priced_cloth_fit(cloth, others, error);
    weft_dataset_close(others);
    WEFT_TRY(code);
    WEFT_TRY(weft_priced_cloth_predictor(cloth, &bench->subset, &predictor, error));
    code = weft_trial_ask(trial, predictor, &answer->held, &answer->fitted, error);
    weft_predictor_free(predictor);
    return code;
}

static weft_code ask_cloth(weft_held_bench *bench, const weft_priced_model *model, const weft_trial *trial,
                           const uint8_t *unseen, said *answer, weft_error *error)
{
    weft_priced_cloth cloth;
    weft_code code = weft_priced_cloth_open(model->cloth, &cloth, error);
    if (code == WEFT_OK)
        code = ask_fitted_cloth(bench, trial, unseen, &cloth, answer, error);
    weft_priced_cloth_free(&cloth);
    return code;
}

static weft_code ask_model(weft_held_bench *bench, const weft_priced_model *model, int split, const weft_trial *trial,
                           const uint8_t *unseen, said *answer, weft_weight *weight, weft_error *error)
{
    if (model->family == WEFT_PRICED_RAW)
        return weft_trial_ask_photographs(trial, model->options.heights, &answer->held, error);
    if (model->family == WEFT_PRICED_BARD || model->family == WEFT_PRICED_RTI)
        return ask_bard_or_rti(bench, model, trial, unseen, answer, error);
    if (model->family == WEFT_PRICED_FACTORISED)
        return ask_factorised(model, trial, unseen, answer, error);
    if (model->family == WEFT_PRICED_CLOTH)
        return ask_cloth(bench, model, trial, unseen, answer, error);
    if (!bench->is_fitted)
        WEFT_TRY(fit_split(bench, model, split, unseen, error));
    return ask_material(bench, model, split, trial, answer, weight, error);
}

/* ---- What can be known ---- */

static weft_code find_known(weft_held_bench *bench, int split, const weft_trial *trial, weft_error *error)
{
    const weft_dataset_layout *layout = &bench->subset.layout;
    size_t samples = (size_t)layout->width * (size_t)layout->height * (size_t)layout->image_count;
    weft_asked_samples seen = {0};
    if (!weft_texel_subset_has_surface(&bench->subset) || bench->known[split])
        return WEFT_OK;
    bench->known[split] = calloc(samples, 1);
    if (!bench->known[split])
        return weft_fail_memory(error, "samples", samples);
    weft_code code = weft_trial_ask_photographs(trial, true, &seen, error);
    for (size_t i = 0; i < seen.count; i++)
        bench->known[split][seen.sample[i]] = 1;
    weft_asked_samples_free(&seen);
    return code;
}

static void keep_known(const uint8_t *known, weft_asked_samples *asked)
{
    size_t kept = 0;
    for (size_t i = 0; known && i < asked->count; i++) {
        if (!known[asked->sample[i]])
            continue;
        asked->value[kept] = asked->value[i];
        asked->sample[kept] = asked->sample[i];
        asked->group[kept++] = asked->group[i];
    }
    asked->count = known ? kept : asked->count;
}

static weft_code take_answer(const weft_held_bench *bench, int split, const weft_trial *trial, said *answer, said *all,
                             weft_held_error *measured, weft_error *error)
{
    WEFT_TRY(append(&all->held, &answer->held, error));
    WEFT_TRY(append(&all->fitted, &answer->fitted, error));
    return bench->has_pictures && split == 0 ? weft_held_pictures_compare(trial, &answer->held, measured, error)
                                             : WEFT_OK;
}

static weft_code measure_split(weft_held_bench *bench, const weft_priced_model *model, int split, said *all,
                               weft_held_error *measured, weft_error *error)
{
    split_masks masks;
    weft_trial trial = {0};
    said answer = {0};
    weft_code code = make_masks(bench, model, split, &masks, error);
    if (code == WEFT_OK)
        code = weft_trial_create(&bench->subset, weft_splits_held(&bench->splits, split), masks.next, &trial, error);
    trial.asked = bench->asked;
    trial.predicts_asked = is_fitted_alone(bench, model);
    if (code == WEFT_OK && bench->for_pictures_alone)
        weft_held_pictures_keep(&trial);
    if (code == WEFT_OK)
        code = ask_model(bench, model, split, &trial, masks.unseen, &answer, &measured->weight, error);
    if (code == WEFT_OK)
        code = find_known(bench, split, &trial, error);
    if (code == WEFT_OK) {
        keep_known(bench->known[split], &answer.held);
        code = take_answer(bench, split, &trial, &answer, all, measured, error);
    }
    free_said(&answer);
    weft_trial_free(&trial);
    free_masks(&masks);
    return code;
}

static weft_code measure_splits(weft_held_bench *bench, const weft_priced_model *model, said *all,
                                weft_held_error *measured, weft_error *error)
{
    for (int split = 0; split < bench->split_count; split++)
        WEFT_TRY(measure_split(bench, model, split, all, measured, error));
    measured->fit_s = bench->fit_s;
    if (bench->for_pictures_alone)
        return WEFT_OK;
    WEFT_TRY(summarise(bench, &all->held, measured->held, error));
    WEFT_TRY(summarise(bench, &all->fitted, measured->fitted, error));
    if (measured->held[WEFT_SAMPLES_ALL].count == 0)
        return weft_fail(error, WEFT_BAD_USAGE, "every sample that was held out is masked");
    return find_interval(bench, &all->held, &measured->interval_width, error);
}

static weft_code measure(weft_held_bench *bench, const weft_priced_model *model, weft_held_error *measured,
                         weft_error *error)
{
    said all = {0};
    *measured = (weft_held_error){0};
    if (weft_priced_model_is_fit(model) &&
        !(bench->is_fitted && weft_priced_models_share_fit(model, &bench->fitted_model))) {
        forget_fit(bench);
        bench->fit_s = 0;
    }
    weft_code code = measure_splits(bench, model, &all, measured, error);
    if (code == WEFT_OK && weft_priced_model_is_fit(model)) {
        bench->is_fitted = true;
        bench->fitted_model = *model;
    }
    free_said(&all);
    if (code != WEFT_OK) {
        forget_fit(bench);
        weft_held_error_free(measured);
    }
    return code;
}

weft_code weft_held_bench_measure(weft_held_bench *bench, const weft_priced_model *model, weft_held_error *measured,
                                  weft_error *error)
{
    bench->for_pictures_alone = false;
    return measure(bench, model, measured, error);
}

weft_code weft_held_bench_picture(weft_held_bench *bench, const weft_priced_model *model, weft_held_error *measured,
                                  weft_error *error)
{
    bench->for_pictures_alone = true;
    return measure(bench, model, measured, error);
}
