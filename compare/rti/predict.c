#include "compare/rti/rti.h"

#include "base/half.h"
#include "base/picture/colour.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Without every fifth photograph that much is left. */
static const double least_share = 0.8;

bool weft_rti_is_for(weft_rti_model model, const weft_dataset_layout *layout)
{
    return layout->view_count == 1 && layout->distance == WEFT_FAR &&
           least_share * layout->image_count >= weft_rti_least_photographs(model);
}

/* Texels one after another. Most of them use the same photographs. */
typedef struct prediction {
    const weft_dataset_layout *layout;
    weft_rti_model model;
    weft_vec3 *light;      /* [image_count] */
    float *scale;          /* [image_count] from reflectance times cosine to the quantity of the layout */
    int *used, used_count; /* [image_count] the photographs that the weights are of */
    int *usable, usable_count;
    weft_vec3 *light_of_used; /* [image_count] */
    double *weight;           /* [image_count][used_count] */
    float (*coded)[3];        /* [image_count] */
} prediction;

static void free_prediction(prediction *p)
{
    free(p->light);
    free(p->scale);
    free(p->used);
    free(p->usable);
    free(p->light_of_used);
    free(p->weight);
    free(p->coded);
}

static weft_code allocate(prediction *p, weft_error *error)
{
    size_t count = (size_t)p->layout->image_count;
    p->light = malloc(count * sizeof *p->light);
    p->scale = malloc(count * sizeof *p->scale);
    p->used = malloc(count * sizeof *p->used);
    p->usable = malloc(count * sizeof *p->usable);
    p->light_of_used = malloc(count * sizeof *p->light_of_used);
    p->weight = malloc(count * count * sizeof *p->weight);
    p->coded = malloc(count * sizeof *p->coded);
    if (!p->light || !p->scale || !p->used || !p->usable || !p->light_of_used || !p->weight || !p->coded)
        return weft_fail_memory(error, "weights of photographs", count * count * sizeof *p->weight);
    for (int i = 0; i < p->layout->image_count; i++) {
        p->light[i] = weft_dataset_light_direction(p->layout, i, 0, 0);
        p->scale[i] = p->layout->values == WEFT_REFLECTANCE ? 1 / (float)p->light[i].z : 1;
    }
    return WEFT_OK;
}

static weft_code find_weights(prediction *p, weft_error *error)
{
    if (p->used_count == p->usable_count && memcmp(p->used, p->usable, (size_t)p->used_count * sizeof *p->used) == 0)
        return WEFT_OK;
    p->used_count = p->usable_count;
    memcpy(p->used, p->usable, (size_t)p->used_count * sizeof *p->used);
    for (int i = 0; i < p->used_count; i++)
        p->light_of_used[i] = p->light[p->used[i]];
    return weft_rti_weights(p->model, p->light_of_used, p->used_count, p->light, p->layout->image_count, p->weight,
                            error);
}

static void predict_image(const prediction *p, int image, weft_half *predicted)
{
    const double *weight = p->weight + (size_t)image * (size_t)p->used_count;
    double sum[3] = {0};
    for (int i = 0; i < p->used_count; i++)
        for (int c = 0; c < 3; c++)
            sum[c] += weight[i] * (double)p->coded[i][c];
    for (int c = 0; c < 3; c++)
        predicted[c] = weft_half_of_float(weft_linear_of_srgb(fmaxf((float)sum[c], 0)) * p->scale[image]);
}

static weft_code predict_texel(prediction *p, const uint8_t *left_out, const weft_half *samples, const uint8_t *mask,
                               weft_half *predicted, weft_error *error)
{
    p->usable_count = 0;
    for (int i = 0; i < p->layout->image_count; i++) {
        if (mask[i] || left_out[i] || !(p->light[i].z > 0))
            continue;
        for (int c = 0; c < 3; c++)
            p->coded[p->usable_count][c] = weft_srgb_of_linear(weft_float_of_half(samples[3 * i + c]) / p->scale[i]);
        p->usable[p->usable_count++] = i;
    }
    bool is_enough = p->usable_count >= weft_rti_least_photographs(p->model);
    if (is_enough)
        WEFT_TRY(find_weights(p, error));
    for (int i = 0; i < p->layout->image_count; i++) {
        if (is_enough)
            predict_image(p, i, predicted + 3 * i);
        for (int c = 0; c < 3 && !is_enough; c++)
            predicted[3 * i + c] = weft_half_of_float(NAN);
    }
    return WEFT_OK;
}

weft_code weft_rti_predict_texels(const weft_dataset_layout *layout, const uint8_t *left_out, weft_rti_model model,
                                  const weft_half *samples, const uint8_t *mask, long texel_count, weft_half *predicted,
                                  weft_error *error)
{
    prediction p = {.layout = layout, .model = model};
    size_t images = (size_t)layout->image_count;
    weft_code code = allocate(&p, error);
    for (size_t t = 0; code == WEFT_OK && t < (size_t)texel_count; t++)
        code =
            predict_texel(&p, left_out, samples + 3 * t * images, mask + t * images, predicted + 3 * t * images, error);
    free_prediction(&p);
    return code;
}
