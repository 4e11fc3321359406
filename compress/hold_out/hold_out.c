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

typedef struct held_and_fitted {
    weft_residuals held, fitted;
} held_and_fitted;

/* The whole measurement at work. */
typedef struct measuring {
    const weft_compress_options *given;
    weft_compress_options options; /* of the fits without some images */
    const char *scratch_path;
    weft_measured_texels texels;
    bool asks_heights; /* of components, whether they are to be seen through the surface of the texels */
    weft_splits splits;
    weft_compress_model whole_model; /* that all images carry, and its lobes */
    int whole_lobes;
    weft_hold_out_error flat; /* of the material without heights, where it has been asked with them */
    weft_error_summary flat_fitted;
    weft_means_taken material_taken, flat_taken, photographs_taken;
    int fitted_taken, flat_fitted_taken;
    int measured_count;                        /* of the splits: the first ones */
    bool takes_errors;                         /* of these texels */
    int first_level, last_level;               /* of these texels, whose residuals are taken */
    held_and_fitted residuals, flat_residuals; /* flat: the same without heights */
    weft_hold_out *result;
} measuring;

static weft_code fit_without(const measuring *work, const uint8_t *held, weft_material *material,
                             weft_compress_report *report, weft_error *error)
{
    weft_dataset *others;
    WEFT_TRY(weft_excerpt_write(weft_measured_texels_fitted(&work->texels), held, work->scratch_path, &others, error));
    weft_code code = weft_compress(others, &work->options, NULL, material, report, error);
    weft_dataset_close(others);
    return code;
}

/* What one split says. */
typedef struct answers {
    weft_asked_samples material, fitted, photographs;
    weft_asked_samples photographs_flat;              /* where `photographs` are seen through a surface */
    weft_asked_samples moved;                         /* the material, its stored numbers moved by a step each */
    weft_asked_samples flat, flat_fitted, flat_moved; /* without heights, where `material` is with them */
} answers;

static void free_answers(answers *said)
{
    weft_asked_samples_free(&said->material);
    weft_asked_samples_free(&said->fitted);
    weft_asked_samples_free(&said->photographs);
    weft_asked_samples_free(&said->photographs_flat);
    weft_asked_samples_free(&said->moved);
    weft_asked_samples_free(&said->flat);
    weft_asked_samples_free(&said->flat_fitted);
    weft_asked_samples_free(&said->flat_moved);
}

static weft_code ask_material(const measuring *work, const weft_trial *trial, const weft_material *material,
                              weft_asked_samples *held, weft_asked_samples *fitted, weft_error *error)
{
    const weft_excerpt *excerpt = weft_measured_texels_fitted(&work->texels);
    weft_predictor *predictor;
    WEFT_TRY(weft_predictor_of_window(&excerpt->layout, &excerpt->window, material, &predictor, error));
    weft_code code = weft_trial_ask(trial, predictor, held, fitted, error);
    weft_predictor_free(predictor);
    return code;
}

/* What storage does to it. The material is another one afterwards, without heights. */
static weft_code ask_moved(const measuring *work, const weft_trial *trial, weft_material *material, answers *said,
                           weft_error *error)
{
    weft_trial held_alone = *trial;
    weft_asked_samples none = {0};
    held_alone.fitted_count = 0;
    weft_material_move_by_steps(material);
    weft_code code = ask_material(work, &held_alone, material, &said->moved, &none, error);
    weft_asked_samples_free(&none);
    if (code != WEFT_OK || !material->heights)
        return code;
    weft_material_take_heights(material, NULL);
    code = ask_material(work, &held_alone, material, &said->flat_moved, &none, error);
    weft_asked_samples_free(&none);
    return code;
}

static weft_code ask(const measuring *work, const weft_trial *trial, weft_material *material, answers *said,
                     weft_error *error)
{
    if (work->asks_heights && material->components) {
        WEFT_TRY(ask_material(work, trial, material, &said->flat, &said->flat_fitted, error));
        WEFT_TRY(weft_excerpt_give_heights(&work->texels.excerpt, material, error));
    }
    WEFT_TRY(ask_material(work, trial, material, &said->material, &said->fitted, error));
    return ask_moved(work, trial, material, said, error);
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

static weft_code take_flat(measuring *work, const answers *said, weft_error *error)
{
    weft_hold_out_error flat;
    weft_error_summary fitted;
    double error_of[2];
    if (!said->flat.value)
        return WEFT_OK;
    WEFT_TRY(weft_hold_out_summarise(&said->flat, &flat, error));
    WEFT_TRY(weft_error_summary_of(said->flat_fitted.value, said->flat_fitted.count, &fitted, error));
    weft_hold_out_take(&flat, &work->flat_taken, &work->flat);
    weft_summary_take(&fitted, &work->flat_fitted_taken, &work->flat_fitted);
    compare_with_flat(&said->material, &said->flat, error_of);
    work->result->heights.asked = true;
    work->result->heights.with += error_of[0] / work->measured_count;
    work->result->heights.without += error_of[1] / work->measured_count;
    return WEFT_OK;
}

/* What is said of the material is what is played of it. */
static void decide_on_heights(measuring *work)
{
    weft_hold_out_heights *heights = &work->result->heights;
    heights->used = heights->asked && work->result->material.all.count > 0 &&
                    heights->with <= WEFT_HOLD_OUT_HEIGHTS_GAIN * heights->without;
    if (!heights->asked || heights->used)
        return;
    work->result->material = work->flat;
    work->result->fitted = work->flat_fitted;
}

static weft_code take_answers(measuring *work, const answers *said, weft_error *error)
{
    weft_hold_out_error material;
    weft_error_summary fitted;
    WEFT_TRY(weft_hold_out_summarise(&said->material, &material, error));
    WEFT_TRY(weft_error_summary_of(said->fitted.value, said->fitted.count, &fitted, error));
    weft_hold_out_take(&material, &work->material_taken, &work->result->material);
    weft_summary_take(&fitted, &work->fitted_taken, &work->result->fitted);
    return take_flat(work, said, error);
}

static void free_residuals(held_and_fitted *residuals)
{
    weft_residuals_free(&residuals->held);
    weft_residuals_free(&residuals->fitted);
}

static weft_code add_residuals(const measuring *work, int split, const weft_asked_samples *material,
                               const weft_asked_samples *moved, const weft_asked_samples *fitted,
                               held_and_fitted *residuals, weft_error *error)
{
    const weft_excerpt *excerpt = &work->texels.excerpt;
    const weft_residuals_taken taken = {.first_image = (uint32_t)split * (uint32_t)work->splits.image_count,
                                        .most = most_residuals / (size_t)work->measured_count,
                                        .first_level = work->first_level,
                                        .last_level = work->last_level,
                                        .level = work->texels.level};
    WEFT_TRY(weft_residuals_add(&residuals->held, excerpt, material, moved, &taken, error));
    return weft_residuals_add(&residuals->fitted, excerpt, fitted, NULL, &taken, error);
}

static weft_code take_residuals(measuring *work, int split, const answers *said, weft_error *error)
{
    WEFT_TRY(add_residuals(work, split, &said->material, &said->moved, &said->fitted, &work->residuals, error));
    if (!said->flat.value)
        return WEFT_OK;
    return add_residuals(work, split, &said->flat, &said->flat_moved, &said->flat_fitted, &work->flat_residuals, error);
}

static weft_code take_photographs(measuring *work, const answers *said, weft_error *error)
{
    weft_hold_out_error photographs;
    double error_of[2];
    WEFT_TRY(weft_hold_out_summarise(&said->photographs, &photographs, error));
    weft_hold_out_take(&photographs, &work->photographs_taken, &work->result->photographs);
    if (!said->photographs_flat.value)
        return WEFT_OK;
    compare_with_flat(&said->photographs, &said->photographs_flat, error_of);
    work->result->photographs_flat += error_of[1] / work->measured_count;
    return WEFT_OK;
}

/* Before the material is asked, so that what they say is not in memory beside what it says. */
static weft_code ask_photographs(measuring *work, const weft_trial *trial, weft_error *error)
{
    answers said = {0};
    bool has_surface = weft_excerpt_has_surface(&work->texels.excerpt);
    weft_code code = has_surface ? weft_trial_ask_photographs(trial, false, &said.photographs_flat, error) : WEFT_OK;
    if (code == WEFT_OK)
        code = weft_trial_ask_photographs(trial, has_surface, &said.photographs, error);
    if (code == WEFT_OK)
        code = take_photographs(work, &said, error);
    free_answers(&said);
    malloc_trim(0);
    return code;
}

static weft_code ask_split(measuring *work, int split, answers *said, weft_error *error)
{
    const uint8_t *held = weft_splits_held(&work->splits, split);
    const uint8_t *next = weft_splits_held(&work->splits, (split + 1) % work->splits.count);
    weft_material material;
    weft_compress_report report;
    WEFT_TRY(fit_without(work, held, &material, &report, error));
    work->result->smaller_model |= report.model != work->whole_model || report.lobe_count != work->whole_lobes;
    weft_trial trial;
    weft_code code = weft_trial_create(&work->texels.excerpt, held, next, &trial, error);
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
    answers said = {0};
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

static weft_code certify(weft_dataset *dataset, measuring *work, weft_error *error)
{
    weft_hold_out *result = work->result;
    bool is_flat = result->heights.asked && !result->heights.used;
    const held_and_fitted *by = is_flat ? &work->flat_residuals : &work->residuals;
    WEFT_TRY(weft_certify(&by->held, &by->fitted, certified, work->texels.spacing, work->texels.neighbours,
                          &result->certificate, &result->has_certificate, error));
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
    const weft_excerpt *fitted = weft_measured_texels_fitted(&work->texels);
    if (weft_excerpt_is_masked(fitted))
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
    work->asks_heights = work->given->heights && weft_excerpt_has_surface(&work->texels.excerpt);
    return measure_texels(work, progress, error);
}

static weft_code measure_splits(weft_dataset *dataset, measuring *work, const weft_progress *progress,
                                weft_error *error)
{
    work->whole_model = weft_compress_plan(weft_dataset_get_layout(dataset), &work->options, &work->whole_lobes);
    if (weft_measures_spread_texels(dataset, &work->options, &work->splits))
        WEFT_TRY(measure_spread_texels(dataset, work, progress, error));
    else
        WEFT_TRY(measure_neighbours(dataset, work, progress, error));
    decide_on_heights(work);
    if (work->result->material.all.count == 0)
        return weft_fail(error, WEFT_BAD_USAGE, "every sample that was held out is masked");
    return certify(dataset, work, error);
}

weft_code weft_hold_out_measure(weft_dataset *dataset, const weft_compress_options *options, int split_count,
                                const char *scratch_path, const weft_progress *progress, weft_hold_out *result,
                                weft_error *error)
{
    measuring work = {.given = options, .options = *options, .scratch_path = scratch_path, .result = result};
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
    free_residuals(&work.residuals);
    free_residuals(&work.flat_residuals);
    weft_measured_texels_free(&work.texels);
    weft_splits_free(&work.splits);
    /* What is free is given back to the system, so that the fit of the whole has room. */
    malloc_trim(0);
    return code;
}
