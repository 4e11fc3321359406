#include "compress/components/known.h"

#include <math.h>
#include <stdlib.h>

void weft_known_free(weft_known *k)
{
    free(k->image);
    free(k->pair);
    free(k->weight);
    free(k->sample);
    *k = (weft_known){0};
}

static weft_code known_allocate(int count, int series_count, weft_known *k, weft_error *error)
{
    size_t all = count > 0 ? (size_t)count : 1; /* one that is not used, where nothing is known */
    *k = (weft_known){.count = count,
                      .series_count = series_count,
                      .image = calloc(all, sizeof *k->image),
                      .pair = calloc(all, sizeof *k->pair),
                      .weight = calloc(all, sizeof *k->weight),
                      .sample = calloc(all * (size_t)series_count, sizeof *k->sample)};
    if (k->image && k->pair && k->weight && k->sample)
        return WEFT_OK;
    weft_known_free(k);
    return weft_fail_memory(error, "samples to complete", all * (size_t)series_count * sizeof(double));
}

weft_kriging_places weft_known_places(const weft_known *k)
{
    return (weft_kriging_places){k->count, k->pair, k->weight};
}

int weft_even_choice(int i, int some, int all)
{
    return (int)((long)i * all / some);
}

int weft_at_most(int count, int most)
{
    return count < most ? count : most;
}

static int view_of(const weft_component_images *images, int image)
{
    int view = 0;
    while ((int)images->first[view + 1] <= image)
        view++;
    return view;
}

static void take_sample(const weft_training *training, const weft_component_images *images, int texel, int image,
                        weft_known *k, int series, int at)
{
    const float *vector = training->vector + (size_t)texel * training->length + 3 * (size_t)image;
    for (int c = 0; c < 3; c++)
        k->sample[(size_t)(series + c) * (size_t)k->count + (size_t)at] = (double)(vector[c] / images->weight[image]);
}

static void take_image(const weft_component_images *images, int image, weft_known *k, int at)
{
    k->image[at] = image;
    k->pair[at] = weft_direction_pair_of(images->light[image], images->view[view_of(images, image)]);
    k->weight[at] = (double)(images->weight[image] * images->weight[image]);
}

/* Whether any of the texels first .. last has a sample of an image. */
static bool is_seen(const weft_training *training, int first, int last, int image)
{
    for (int texel = first; texel <= last; texel++) {
        if (training->known[(size_t)texel * training->image_count + (size_t)image])
            return true;
    }
    return false;
}

weft_code weft_known_take(const weft_training *training, const weft_component_images *images, int first, int last,
                          int most, weft_known *k, weft_error *error)
{
    int all = 0, found = 0, taken = 0;
    for (int i = 0; i < images->image_count; i++)
        all += is_seen(training, first, last, i);
    int count = weft_at_most(all, most);
    WEFT_TRY(known_allocate(count, 3 * (last - first + 1), k, error));
    for (int i = 0; i < images->image_count && taken < count; i++) {
        if (!is_seen(training, first, last, i) || found++ != weft_even_choice(taken, count, all))
            continue;
        take_image(images, i, k, taken);
        for (int texel = first; texel <= last; texel++)
            take_sample(training, images, texel, i, k, 3 * (texel - first), taken);
        taken++;
    }
    return WEFT_OK;
}

double weft_known_mean_square(const weft_known *k)
{
    size_t count = (size_t)k->count * (size_t)k->series_count;
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += k->sample[i] * k->sample[i];
    return count > 0 ? sum / (double)count : 0;
}

/* ---- The mean texel ---- */

enum { CHANNELS = 3 };

weft_code weft_mean_texel_take(const weft_known *k, double **sample, weft_error *error)
{
    size_t count = (size_t)k->count, all = count > 0 ? count : 1;
    *sample = calloc(CHANNELS * all, sizeof **sample);
    if (!*sample)
        return weft_fail_memory(error, "the mean texel", CHANNELS * all * sizeof **sample);
    for (size_t series = 0; series < (size_t)k->series_count; series++)
        for (size_t i = 0; i < count; i++)
            (*sample)[series % CHANNELS * count + i] += k->sample[series * count + i] * CHANNELS / k->series_count;
    return WEFT_OK;
}

weft_code weft_mean_texel_choose(const weft_known *k, const weft_covariance *texels, const weft_progress *progress,
                                 weft_covariance *covariance, double error_of[2], weft_error *error)
{
    double *sample;
    WEFT_TRY(weft_mean_texel_take(k, &sample, error));
    weft_kriging_samples set = {weft_known_places(k), CHANNELS, sample};
    weft_code code = weft_kriging_leave_out(&set, 1, texels, &error_of[0], error);
    if (code == WEFT_OK)
        code = weft_kriging_choose_mean(&set, progress, covariance, &error_of[1], error);
    if (code == WEFT_OK && error_of[1] >= error_of[0])
        covariance->is_of_mean = false;
    free(sample);
    return code;
}

/* From the weights a of the mean's samples. */
static void predict(const weft_covariance_terms *terms, const weft_known *k, const double *weight,
                    const weft_direction_pair *at, double value[CHANNELS])
{
    size_t count = (size_t)k->count;
    for (size_t c = 0; c < CHANNELS; c++)
        value[c] = 0;
    for (size_t i = 0; i < count; i++) {
        double covariance = weft_covariance_between(terms, at, &k->pair[i]);
        for (size_t c = 0; c < CHANNELS; c++)
            value[c] += covariance * weight[c * count + i];
    }
}

static void scale(weft_training *training, size_t at, double value)
{
    double mean = 0;
    for (size_t texel = 0; texel < (size_t)training->texel_count; texel++)
        mean += (double)training->vector[texel * training->length + at] / training->texel_count;
    if (!(mean > 0)) /* nothing to scale */
        return;
    float factor = (float)(fmax(value, 0) / mean);
    for (size_t texel = 0; texel < (size_t)training->texel_count; texel++)
        training->vector[texel * training->length + at] *= factor;
}

weft_code weft_mean_texel_impose(const weft_known *k, double *sample, const weft_covariance *covariance,
                                 const weft_component_images *images, weft_training *training, weft_error *error)
{
    weft_kriging kriging;
    weft_kriging_places places = weft_known_places(k);
    weft_covariance_terms terms = weft_covariance_terms_of(covariance);
    int lights = images->image_count / images->view_count;
    WEFT_TRY(weft_kriging_create(covariance, &places, &kriging, error));
    weft_kriging_solve(&kriging, sample, CHANNELS);
    weft_kriging_free(&kriging);
#pragma omp parallel for schedule(dynamic, 16)
    for (int i = 0; i < images->image_count; i++) {
        weft_direction_pair pair = weft_direction_pair_of(images->light[i], images->view[i / lights]);
        double value[CHANNELS];
        predict(&terms, k, sample, &pair, value);
        for (size_t c = 0; c < CHANNELS; c++)
            scale(training, CHANNELS * (size_t)i + c, value[c]);
    }
    return WEFT_OK;
}
