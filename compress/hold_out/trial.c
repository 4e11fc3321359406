#include "compress/hold_out/trial.h"

#include <math.h>
#include <stdlib.h>

/* ---- Samples ---- */

/* Empty slots for images of all texels; a slot stays empty where its `group` stays 0. */
static weft_code allocate(const weft_trial *trial, int image_count, weft_asked_samples *asked, weft_error *error)
{
    size_t count = 3 * (size_t)trial->asked.width * (size_t)trial->asked.height * (size_t)image_count;
    *asked = (weft_asked_samples){count, calloc(count + 1, sizeof *asked->value), calloc(count + 1, 1),
                                  calloc(count + 1, sizeof *asked->sample)};
    return asked->value && asked->group && asked->sample
               ? WEFT_OK
               : weft_fail_memory(error, "samples", count * (sizeof *asked->value + sizeof *asked->sample + 1));
}

void weft_asked_samples_free(weft_asked_samples *asked)
{
    free(asked->value);
    free(asked->group);
    free(asked->sample);
    *asked = (weft_asked_samples){0};
}

static void drop_empty_slots(weft_asked_samples *asked)
{
    size_t kept = 0;
    for (size_t i = 0; i < asked->count; i++) {
        if (!asked->group[i])
            continue;
        asked->value[kept] = asked->value[i];
        asked->sample[kept] = asked->sample[i];
        asked->group[kept++] = asked->group[i];
    }
    asked->count = kept;
}

/* Sample `at` of the subset into the slots from `slot` on, unless nothing is said of it. */
static void put(const weft_trial *trial, size_t at, uint8_t flags, weft_rgb said, size_t slot,
                weft_asked_samples *asked)
{
    const weft_half *half = trial->subset->samples + 3 * at;
    const double channel[3] = {(double)said.r, (double)said.g, (double)said.b};
    for (size_t c = 0; c < 3 && !isnan(channel[c]); c++) {
        asked->value[slot + c] =
            (weft_compared){.sample = weft_float_of_half(half[c]), .prediction = (float)channel[c]};
        asked->sample[slot + c] = (uint32_t)at;
        asked->group[slot + c] = flags;
    }
}

/* What is said of images trial->image [first, first + count) of texel (x, y), into its own slots. */
static void put_texel(const weft_trial *trial, int x, int y, int first, int count, const weft_rgb *said,
                      weft_asked_samples *asked)
{
    const weft_dataset_layout *layout = &trial->subset->layout;
    const weft_texel_block *block = &trial->asked;
    size_t texel = (size_t)y * (size_t)layout->width + (size_t)x;
    size_t asked_texel = (size_t)(y - block->y) * (size_t)block->width + (size_t)(x - block->x);
    for (int i = 0; i < count; i++) {
        int image = trial->image[first + i];
        size_t at = texel * (size_t)layout->image_count + (size_t)image;
        weft_vec3 light = weft_dataset_light_direction(layout, image, x, y);
        weft_vec3 view = weft_dataset_view_direction(layout, layout->view_of_image[image], x, y);
        if (!trial->subset->mask[at] && light.z > 0 && view.z > 0)
            put(trial, at, trial->flags[first + i], said[i], 3 * (asked_texel * (size_t)count + (size_t)i), asked);
    }
}

/* ---- The images ---- */

static void list_images(const uint8_t *next, weft_trial *trial)
{
    int image_count = trial->subset->layout.image_count;
    for (int i = 0; i < image_count; i++) {
        if (!trial->held[i])
            continue;
        trial->flags[trial->held_count] = trial->held[i];
        trial->image[trial->held_count++] = i;
    }
    for (int i = 0; i < image_count; i++) {
        if (trial->held[i] || !next[i])
            continue;
        trial->flags[trial->held_count + trial->fitted_count] = next[i];
        trial->image[trial->held_count + trial->fitted_count++] = i;
    }
}

weft_code weft_trial_create(const weft_texel_subset *subset, const uint8_t *held, const uint8_t *next,
                            weft_trial *trial, weft_error *error)
{
    size_t images = (size_t)subset->layout.image_count;
    *trial = (weft_trial){.subset = subset,
                          .held = held,
                          .image = calloc(images, sizeof *trial->image),
                          .flags = calloc(images, 1),
                          .asked = {0, 0, subset->layout.width, subset->layout.height}};
    if (!trial->image || !trial->flags)
        return weft_fail_memory(error, "images", images * (sizeof *trial->image + 1));
    list_images(next, trial);
    return WEFT_OK;
}

void weft_trial_free(weft_trial *trial)
{
    free(trial->image);
    free(trial->flags);
    *trial = (weft_trial){0};
}

/* ---- Asking ---- */

static weft_code ask_texel(const weft_trial *trial, const weft_predictor *predictor, int x, int y,
                           weft_asked_samples *held, weft_asked_samples *fitted, weft_error *error)
{
    int images = trial->held_count + trial->fitted_count;
    weft_rgb *said = malloc((size_t)(images + 1) * sizeof *said);
    if (!said)
        return weft_fail_memory(error, "predictions", (size_t)images * sizeof *said);
    int left = trial->predicts_asked ? trial->asked.x : 0, top = trial->predicts_asked ? trial->asked.y : 0;
    weft_predictor_predict(predictor, x - left, y - top, trial->image, images, said);
    put_texel(trial, x, y, 0, trial->held_count, said, held);
    put_texel(trial, x, y, trial->held_count, trial->fitted_count, said + trial->held_count, fitted);
    free(said);
    return WEFT_OK;
}

static weft_code ask_texel_of_photographs(const weft_trial *trial, const weft_interpolation *interpolation, int x,
                                          int y, weft_asked_samples *held, weft_error *error)
{
    weft_rgb *said = malloc((size_t)(trial->held_count + 1) * sizeof *said);
    if (!said)
        return weft_fail_memory(error, "predictions", (size_t)trial->held_count * sizeof *said);
    weft_code code = weft_interpolation_predict(interpolation, x, y, said, error);
    if (code == WEFT_OK)
        put_texel(trial, x, y, 0, trial->held_count, said, held);
    free(said);
    return code;
}

/* A predictor or else an interpolation is asked, texel by texel. */
static weft_code ask_texels(const weft_trial *trial, const weft_predictor *predictor,
                            const weft_interpolation *interpolation, weft_asked_samples *held,
                            weft_asked_samples *fitted, weft_error *error)
{
    const weft_texel_block *block = &trial->asked;
    int texels = block->width * block->height;
    weft_code code = WEFT_OK;
#pragma omp parallel for schedule(dynamic, 1)
    for (int texel = 0; texel < texels; texel++) {
        weft_error own = {0};
        int x = block->x + texel % block->width, y = block->y + texel / block->width;
        weft_code own_code = predictor ? ask_texel(trial, predictor, x, y, held, fitted, &own)
                                       : ask_texel_of_photographs(trial, interpolation, x, y, held, &own);
#pragma omp critical
        if (own_code != WEFT_OK) {
            code = own_code;
            if (error)
                *error = own;
        }
    }
    return code;
}

weft_code weft_trial_ask(const weft_trial *trial, const weft_predictor *predictor, weft_asked_samples *held,
                         weft_asked_samples *fitted, weft_error *error)
{
    *held = *fitted = (weft_asked_samples){0};
    WEFT_TRY(allocate(trial, trial->held_count, held, error));
    WEFT_TRY(allocate(trial, trial->fitted_count, fitted, error));
    WEFT_TRY(ask_texels(trial, predictor, NULL, held, fitted, error));
    drop_empty_slots(held);
    drop_empty_slots(fitted);
    return WEFT_OK;
}

weft_code weft_trial_ask_photographs(const weft_trial *trial, bool through, weft_asked_samples *held, weft_error *error)
{
    weft_interpolation *interpolation = NULL;
    *held = (weft_asked_samples){0};
    WEFT_TRY(allocate(trial, trial->held_count, held, error));
    WEFT_TRY(weft_interpolation_create(trial->subset, trial->held, trial->image, trial->held_count, through,
                                       &interpolation, error));
    weft_code code = ask_texels(trial, NULL, interpolation, held, NULL, error);
    weft_interpolation_free(interpolation);
    drop_empty_slots(held);
    return code;
}

/* ---- Mean error ---- */

static weft_code summarise_group(const weft_asked_samples *compared, int flags, weft_error_summary *result,
                                 weft_error *error)
{
    return weft_error_summary_of_group(compared->value, compared->group, compared->count, flags, result, error);
}

weft_code weft_hold_out_summarise(const weft_asked_samples *compared, weft_hold_out_error *result, weft_error *error)
{
    WEFT_TRY(weft_error_summary_of(compared->value, compared->count, &result->all, error));
    WEFT_TRY(summarise_group(compared, WEFT_HELD_VIEW, &result->view, error));
    WEFT_TRY(summarise_group(compared, WEFT_HELD_LIGHT, &result->light, error));
    return summarise_group(compared, WEFT_HELD_VIEW | WEFT_HELD_LIGHT, &result->both, error);
}

void weft_summary_take(const weft_error_summary *one, int *taken, weft_error_summary *mean)
{
    if (one->count == 0)
        return;
    double share = 1.0 / ++*taken;
    mean->median_relative += share * (one->median_relative - mean->median_relative);
    mean->percentile80_relative += share * (one->percentile80_relative - mean->percentile80_relative);
    mean->rmse += share * (one->rmse - mean->rmse);
    mean->relative_rmse += share * (one->relative_rmse - mean->relative_rmse);
    mean->psnr_db =
        isinf(one->psnr_db) || isinf(mean->psnr_db) ? INFINITY : mean->psnr_db + share * (one->psnr_db - mean->psnr_db);
    mean->count += one->count;
}

void weft_hold_out_take(const weft_hold_out_error *one, weft_means_taken *taken, weft_hold_out_error *mean)
{
    weft_summary_take(&one->all, &taken->all, &mean->all);
    weft_summary_take(&one->view, &taken->view, &mean->view);
    weft_summary_take(&one->light, &taken->light, &mean->light);
    weft_summary_take(&one->both, &taken->both, &mean->both);
}
