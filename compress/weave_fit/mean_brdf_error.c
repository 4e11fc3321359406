/* How far the mean BRDF of a weave is from data. */
#include "compress/weave_fit/fit_weave.h"

#include "reflectance/weave/batch.h"

#include <math.h>
#include <stdlib.h>

/* Sums over the yarns that are like yarn `kind`: what its reflectance contributes to each channel. */
static weft_rgb colour_of_kind(const weft_weave *weave, int kind)
{
    weft_rgb sum = {0};
    for (int i = kind; i < weave->yarn_count; i++) {
        const weft_yarn *yarn = &weave->yarn[i];
        double share = weave->specular_scale * yarn->cell_fraction * yarn->area_weight;
        if (yarn->alike != kind)
            continue;
        sum.r += share * yarn->ks.r;
        sum.g += share * yarn->ks.g;
        sum.b += share * yarn->ks.b;
    }
    return sum;
}

static weft_rgb diffuse_colour(const weft_weave *weave)
{
    weft_rgb sum = {0};
    for (int i = 0; i < weave->yarn_count; i++) {
        double share = weave->yarn[i].cell_fraction / WEFT_PI;
        sum.r += share * weave->yarn[i].kd.r;
        sum.g += share * weave->yarn[i].kd.g;
        sum.b += share * weave->yarn[i].kd.b;
    }
    return sum;
}

enum { TOGETHER = 128 };

/* weft_weave_mean_brdf for a few images, in batches. */
static void predict(const weft_weave *weave, const weft_vec3 *light, const weft_vec3 *view, int count,
                    weft_rgb *predicted)
{
    weft_vec3 turned_light[TOGETHER], turned_view[TOGETHER];
    weft_real value[TOGETHER];
    for (int i = 0; i < count; i++) {
        predicted[i] = diffuse_colour(weave);
        turned_light[i] = weft_vec3_of(-light[i].y, light[i].x, light[i].z);
        turned_view[i] = weft_vec3_of(-view[i].y, view[i].x, view[i].z);
    }
    for (int kind = 0; kind < weave->yarn_count; kind++) {
        const weft_yarn *yarn = &weave->yarn[kind];
        weft_rgb colour = colour_of_kind(weave, kind);
        if (!(colour.r + colour.g + colour.b > 0))
            continue;
        weft_prepared_reflectance_batch(&yarn->prepared, count, yarn->warp ? light : turned_light,
                                        yarn->warp ? view : turned_view, value);
        for (int i = 0; i < count; i++) {
            predicted[i].r += colour.r * value[i];
            predicted[i].g += colour.g * value[i];
            predicted[i].b += colour.b * value[i];
        }
    }
}

/* The channels of one image, data and model. */
static void keep(weft_rgb data, weft_rgb model, weft_compared value[3])
{
    value[0] = (weft_compared){.sample = (float)data.r, .prediction = (float)model.r};
    value[1] = (weft_compared){.sample = (float)data.g, .prediction = (float)model.g};
    value[2] = (weft_compared){.sample = (float)data.b, .prediction = (float)model.b};
}

weft_code weft_fit_weave_measure(const weft_mean_brdf *mean, const weft_weave *weave, weft_error_summary *result,
                                 weft_error *error)
{
    size_t count = (size_t)mean->count;
    weft_compared *value = malloc(3 * count * sizeof *value);
    weft_rgb *predicted = malloc(count * sizeof *predicted);
    weft_code code = WEFT_OK;
    if (value && predicted) {
#pragma omp parallel for schedule(dynamic)
        for (int first = 0; first < mean->count; first += TOGETHER) {
            int some = mean->count - first < TOGETHER ? mean->count - first : TOGETHER;
            predict(weave, mean->light + first, mean->view + first, some, predicted + first);
        }
        for (size_t i = 0; i < count; i++)
            keep(mean->value[i], predicted[i], value + 3 * i);
        code = weft_error_summary_of(value, 3 * count, result, error);
    } else {
        code = weft_fail_memory(error, "relative errors", count * (3 * sizeof *value + sizeof *predicted));
    }
    free(value);
    free(predicted);
    return code;
}
