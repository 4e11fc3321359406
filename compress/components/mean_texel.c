#include "compress/components/mean_texel.h"

#include <math.h>
#include <stdlib.h>

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
