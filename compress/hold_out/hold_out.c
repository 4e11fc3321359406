#include "compress/hold_out/hold_out.h"

#include "base/integers.h"
#include "compress/hold_out/certify.h"
#include "compress/hold_out/measured_texels.h"
#include "compress/hold_out/trial.h"

#include <malloc.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of all splits, that a certificate is made of: the share of 95 % is known to 0.001 by so many. */
static const size_t most_residuals = 1 << 16;

static const double certified = 0.95;

/* ---- The fits ---- */

/* A material is seen as it is, or through the heights of the dataset. */
enum { FLAT, THROUGH_HEIGHTS, WAYS };

/* What all splits say of the material, seen in one way. */
typedef struct answers {
    weft_hold_out_error error;
    weft_error_summary fitted;
    weft_means_taken error_taken;
    int fitted_taken;
    weft_residuals held_residuals, fitted_residuals;
} answers;

/* The whole measurement at work. */
typedef struct measuring {
    const weft_compress_options *given;
    weft_compress_options options; /* of the fits without some images */
    const char *scratch_path;
    weft_measured_texels texels;
    int way_count; /* in which components are seen */
    weft_splits splits;
    /* What all images carry: the model, its lobes, and whether they are scattered. */
    weft_compress_model whole_model;
    int whole_lobes;
    bool whole_scattered;
    answers said[WAYS];
    weft_means_taken photographs_taken;
    int measured_count;          /* of the splits: the first ones */
    bool takes_errors;           /* of these texels */
    int first_level, last_level; /* of these texels, whose residuals are taken */
    weft_hold_out *result;
} measuring;

static weft_code fit_without(const measuring *work, const uint8_t *held, weft_material *material,
                             weft_compress_report *report, weft_error *error)
{
    weft_dataset *others;
    WEFT_TRY(
        weft_texel_subset_write(weft_measured_texels_fitted(&work->texels), held, work->scratch_path, &others, error));
    weft_code code = weft_compress(others, &work->options, NULL, material, report, error);
    weft_dataset_close(others);
    return code;
}

/* What one split says of the material, seen in each way. */
typedef struct split_answers {
    weft_asked_samples held[WAYS], fitted[WAYS];
    weft_asked_samples moved[WAYS]; /* the held ones of a material whose stored numbers were moved by a step each */
} split_answers;

static void free_answers(split_answers *said)
{
    for (int way = 0; way < WAYS; way++) {
        weft_asked_samples_free(&said->held[way]);
        weft_asked_samples_free(&said->fitted[way]);
        weft_asked_samples_free(&said->moved[way]);
    }
}

static weft_code ask_material(const measuring *work, const weft_trial *trial, const weft_material *material,
                              weft_asked_samples *held, weft_asked_samples *fitted, weft_error *error)
{
    const weft_texel_subset *subset = weft_measured_texels_fitted(&work->texels);
    weft_predictor *predictor;
    WEFT_TRY(weft_predictor_of_window(&subset->layout, &subset->window, material, &predictor, error));
    weft_code code = weft_trial_ask(trial, predictor, held, fitted, error);
    weft_predictor_free(predictor);
    return code;
}

/* Also what storage does to it: the material is another one afterwards, without heights. */
static weft_code ask(const measuring *work, const weft_trial *trial, weft_material *material, split_answers *said,
                     weft_error *error)
{
    weft_trial held_alone = *trial;
    held_alone.fitted_count = 0;
    for (int way = 0; way < work->way_count; way++) {
        if (way == THROUGH_HEIGHTS)
            WEFT_TRY(weft_texel_subset_give_heights(&work->texels.subset, material, error));
        WEFT_TRY(ask_material(work, trial, material, &said->held[way], &said->fitted[way], error));
    }
    weft_material_move_by_steps(material);
    for (int way = work->way_count - 1; way >= 0; way--) {
        weft_asked_samples none = {0};
        if (way == FLAT && material->heights)
            weft_material_take_heights(material, NULL);
        weft_code code = ask_material(work, &held_alone, material, &said->moved[way], &none, error);
        weft_asked_samples_free(&none);
        WEFT_TRY(code);
    }
    return WEFT_OK;
}

/* Relative RMSE with and without heights where both are known. Samples ascend in both; masks may leave either without
 * some that the other has. */
static void compare_with_flat(const weft_asked_samples *with, const weft_asked_samples *flat, double error_of[2])
{
    double square[2] = {0}, energy = 1e-30;
    for (size_t i = 0, at = 0; i < with->count; i++) {
        while (at < flat->count && flat->sample[at] < with->sample[i])
            at++;
        if (at == flat->count || flat->sample[at] != with->sample[i])
            continue;
        double sample = (double)with->value[i].sample,
               apart[2] = {(double)with->value[i].prediction - sample, (double)flat->value[at].prediction - sample};
        square[0] += apart[0] * apart[0];
        square[1] += apart[1] * apart[1];
        energy += sample * sample;
        at++;
    }
    error_of[0] = sqrt(square[0] / energy);
    error_of[1] = sqrt(square[1] / energy);
}

/* Seen in one way. */
static weft_code take_errors(const weft_asked_samples *held, const weft_asked_samples *fitted, answers *all,
                             weft_error *error)
{
    weft_hold_out_error held_error;
    weft_error_summary fitted_error;
    WEFT_TRY(weft_hold_out_summarise(held, &held_error, error));
    WEFT_TRY(weft_error_summary_of(fitted->value, fitted->count, &fitted_error, error));
    weft_hold_out_take(&held_error, &all->error_taken, &all->error);
    weft_summary_take(&fitted_error, &all->fitted_taken, &all->fitted);
    return WEFT_OK;
}

static weft_code take_answers(measuring *work, const split_answers *said, weft_error *error)
{
    double error_of[2];
    for (int way = 0; way < work->way_count; way++)
        WEFT_TRY(take_errors(&said->held[way], &said->fitted[way], &work->said[way], error));
    if (work->way_count < WAYS)
        return WEFT_OK;
    compare_with_flat(&said->held[THROUGH_HEIGHTS], &said->held[FLAT], error_of);
    work->result->heights.asked = true;
    work->result->heights.with += error_of[0] / work->measured_count;
    work->result->heights.without += error_of[1] / work->measured_count;
    return WEFT_OK;
}

/* What is said of the material is what is played of it. */
static const answers *decide_on_heights(const measuring *work)
{
    weft_hold_out_heights *heights = &work->result->heights;
    heights->used = heights->asked && work->said[THROUGH_HEIGHTS].error.all.count > 0 &&
                    heights->with <= WEFT_HOLD_OUT_HEIGHTS_GAIN * heights->without;
    return &work->said[heights->used ? THROUGH_HEIGHTS : FLAT];
}

static weft_code take_residuals(measuring *work, int split, const split_answers *said, weft_error *error)
{
    const weft_texel_subset *subset = &work->texels.subset;
    const weft_residuals_taken taken = {.first_image = (uint32_t)split * (uint32_t)work->splits.image_count,
                                        .most = most_residuals / (size_t)work->measured_count,
                                        .first_level = work->first_level,
                                        .last_level = work->last_level,
                                        .level = work->texels.level};
    for (int way = 0; way < work->way_count; way++) {
        answers *all = &work->said[way];
        WEFT_TRY(weft_residuals_add(&all->held_residuals, subset, &said->held[way], &said->moved[way], &taken, error));
        WEFT_TRY(weft_residuals_add(&all->fitted_residuals, subset, &said->fitted[way], NULL, &taken, error));
    }
    return WEFT_OK;
}

/* `flat`: without the surface through which `photographs` are seen, where there is one. */
static weft_code take_photographs(measuring *work, const weft_asked_samples *photographs,
                                  const weft_asked_samples *flat, weft_error *error)
{
    weft_hold_out_error own;
    double error_of[2];
    WEFT_TRY(weft_hold_out_summarise(photographs, &own, error));
    weft_hold_out_take(&own, &work->photographs_taken, &work->result->photographs);
    if (!flat->value)
        return WEFT_OK;
    compare_with_flat(photographs, flat, error_of);
    work->result->photographs_flat += error_of[1] / work->measured_count;
    return WEFT_OK;
}

/* Before the material is asked, so that what they say is not in memory beside what it says. */
static weft_code ask_photographs(measuring *work, const weft_trial *trial, weft_error *error)
{
    weft_asked_samples photographs = {0}, flat = {0};
    bool has_surface = weft_texel_subset_has_surface(&work->texels.subset);
    weft_code code = has_surface ? weft_trial_ask_photographs(trial, false, &flat, error) : WEFT_OK;
    if (code == WEFT_OK)
        code = weft_trial_ask_photographs(trial, has_surface, &photographs, error);
    if (code == WEFT_OK)
        code = take_photographs(work, &photographs, &flat, error);
    weft_asked_samples_free(&photographs);
    weft_asked_samples_free(&flat);
    malloc_trim(0);
    return code;
}

static weft_code ask_split(measuring *work, int split, split_answers *said, weft_error *error)
{
    const uint8_t *held = weft_splits_held(&work->splits, split);
    const uint8_t *next = weft_splits_held(&work->splits, (split + 1) % work->splits.count);
    weft_material material;
    weft_compress_report report;
    WEFT_TRY(fit_without(work, held, &material, &report, error));
    work->result->smaller_model |=
        report.model != work->whole_model || report.lobe_count != work->whole_lobes ||
        (report.model == WEFT_COMPRESS_COMPONENTS && report.components.scattered != work->whole_scattered);
    weft_trial trial;
    weft_code code = weft_trial_create(&work->texels.subset, held, next, &trial, error);
    if (work->texels.asked.width > 0)
        trial.asked = work->texels.asked;
    trial.predicts_asked = work->texels.alone.samples != NULL;
    if (code == WEFT_OK && work->takes_errors)
        code = ask_photographs(work, &trial, error);
    if (code == WEFT_OK)
        code = ask(work, &trial, &material, said, error);
    weft_trial_free(&trial);
    weft_material_free(&material);
    return code;
}

/* One thing after the other goes, since memory is promised (--memory). */
static weft_code measure_split(measuring *work, int split, weft_error *error)
{
    split_answers said = {0};
    weft_code code = ask_split(work, split, &said, error);
    if (code == WEFT_OK && work->takes_errors)
        code = take_answers(work, &said, error);
    if (code == WEFT_OK)
        code = take_residuals(work, split, &said, error);
    free_answers(&said);
    return code;
}

/* ---- The certificate ---- */

/* Views and lights of the splits; images where each has directions of its own. */
static int held_directions(const measuring *work)
{
    const weft_splits *splits = &work->splits;
    bool is_grid = splits->kind == WEFT_SPLIT_DIRECTIONS;
    return is_grid ? work->measured_count * (splits->view_held_count + splits->light_held_count)
                   : work->result->certificate.image_count;
}

static weft_code certify(weft_dataset *dataset, const measuring *work, const answers *by, weft_error *error)
{
    weft_hold_out *result = work->result;
    WEFT_TRY(weft_certify(&by->held_residuals, &by->fitted_residuals, certified, work->texels.spacing,
                          work->texels.neighbours, &result->certificate, &result->has_certificate, error));
    result->certificate.direction_count = held_directions(work);
    return result->has_certificate ? weft_certify_registration(dataset, &result->certificate, error) : WEFT_OK;
}

/* ---- The whole ---- */

static void describe(const weft_dataset_layout *layout, measuring *work)
{
    const weft_splits *splits = &work->splits;
    long held = 0;
    for (size_t i = 0; i < (size_t)splits->count * (size_t)splits->image_count; i++)
        held += splits->held[i] != 0;
    *work->result = (weft_hold_out){.kind = splits->kind,
                                    .split_count = work->measured_count,
                                    .view_count = splits->view_count,
                                    .view_held_count = splits->view_held_count,
                                    .light_count = splits->light_count,
                                    .light_held_count = splits->light_held_count,
                                    .image_count = splits->image_count,
                                    .image_held_count = (int)lround((double)held / splits->count),
                                    .texel_count = weft_measured_texels_count(&work->texels),
                                    .dataset_texel_count = (long)layout->width * layout->height};
}

/* Of the texels that were read. */
static weft_code measure_texels(measuring *work, const weft_progress *progress, weft_error *error)
{
    static const char step[] = "fitting without some images";
    const weft_texel_subset *fitted = weft_measured_texels_fitted(&work->texels);
    if (weft_texel_subset_is_masked(fitted))
        return weft_fail(error, WEFT_BAD_USAGE, "every sample of the texels that were tried is masked");
    for (int s = 0; s < work->measured_count; s++) {
        weft_progress_report(progress, step, s, work->measured_count);
        WEFT_TRY(measure_split(work, s, error));
    }
    weft_progress_report(progress, step, work->measured_count, work->measured_count);
    return WEFT_OK;
}

/* Errors and level 0 are of single texels, the other levels of texels of their own. */
static weft_code measure_spread_texels(weft_dataset *dataset, measuring *work, const weft_progress *progress,
                                       weft_error *error)
{
    work->takes_errors = true;
    work->last_level = 0;
    WEFT_TRY(weft_measured_texels_read_spread(dataset, &work->options, &work->texels, error));
    describe(weft_dataset_get_layout(dataset), work);
    WEFT_TRY(measure_texels(work, progress, error));
    weft_measured_texels_free(&work->texels);
    work->takes_errors = false;
    work->first_level = 1;
    work->last_level = WEFT_RESIDUAL_LEVELS - 1;
    WEFT_TRY(weft_measured_texels_read_levels(dataset, &work->options, &work->texels, error));
    return measure_texels(work, progress, error);
}

/* All levels are of the same texels. */
static weft_code measure_neighbours(weft_dataset *dataset, measuring *work, const weft_progress *progress,
                                    weft_error *error)
{
    work->takes_errors = true;
    work->last_level = WEFT_RESIDUAL_LEVELS - 1;
    WEFT_TRY(weft_measured_texels_read(dataset, &work->options, &work->splits, &work->texels, error));
    describe(weft_dataset_get_layout(dataset), work);
    if (work->given->heights && work->options.component_count > 0 &&
        weft_texel_subset_has_surface(&work->texels.subset))
        work->way_count = WAYS;
    return measure_texels(work, progress, error);
}

static weft_code measure_splits(weft_dataset *dataset, measuring *work, const weft_progress *progress,
                                weft_error *error)
{
    work->whole_model = weft_compress_plan(weft_dataset_get_layout(dataset), &work->options, &work->whole_lobes);
    work->whole_scattered = weft_images_are_scattered(weft_dataset_get_layout(dataset));
    if (weft_measures_spread_texels(dataset, &work->options, &work->splits))
        WEFT_TRY(measure_spread_texels(dataset, work, progress, error));
    else
        WEFT_TRY(measure_neighbours(dataset, work, progress, error));
    const answers *played = decide_on_heights(work);
    work->result->material = played->error;
    work->result->fitted = played->fitted;
    if (played->error.all.count == 0)
        return weft_fail(error, WEFT_BAD_USAGE, "every sample that was held out is masked");
    return certify(dataset, work, played, error);
}

weft_code weft_hold_out_measure(weft_dataset *dataset, const weft_compress_options *options, int split_count,
                                const char *scratch_path, const weft_progress *progress, weft_hold_out *result,
                                weft_error *error)
{
    measuring work = {
        .given = options, .options = *options, .scratch_path = scratch_path, .way_count = 1, .result = result};
    work.options.levels = work.options.heights = false;
    work.options.held_out = NULL;
    work.options.checkpoint_path = NULL;
    /* The one after the last is that of the fitted images. */
    int most = split_count > 1 ? split_count : 2;
    weft_code code = weft_splits_create(weft_dataset_get_layout(dataset), 0, most, &work.splits, error);
    bool each = work.splits.kind == WEFT_SPLIT_EACH;
    work.measured_count = each || split_count > work.splits.count ? work.splits.count : split_count;
    if (code == WEFT_OK)
        code = measure_splits(dataset, &work, progress, error);
    for (int way = 0; way < WAYS; way++) {
        weft_residuals_free(&work.said[way].held_residuals);
        weft_residuals_free(&work.said[way].fitted_residuals);
    }
    weft_measured_texels_free(&work.texels);
    weft_splits_free(&work.splits);
    /* What is free is given back to the system, so that the fit of the whole has room. */
    malloc_trim(0);
    return code;
}
