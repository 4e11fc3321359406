#include "compress/bard/texel_table.h"

#include <stdlib.h>
#include <string.h>

/* The largest half float: a gain of 365 on a bright sample is still a number. */
static const float largest_sample = 65504;

weft_code weft_bard_texel_create(const weft_bard_plan *plan, weft_bard_texel *texel, weft_error *error)
{
    size_t count = (size_t)plan->count;
    texel->specular = calloc(count, sizeof *texel->specular);
    texel->is_valid = calloc(count, sizeof *texel->is_valid);
    if (!texel->specular || !texel->is_valid)
        return weft_fail_memory(error, "table of a texel", count * sizeof *texel->specular);
    return WEFT_OK;
}

void weft_bard_texel_free(weft_bard_texel *texel)
{
    free(texel->specular);
    free(texel->is_valid);
    *texel = (weft_bard_texel){0};
}

/* What turns BRDF x pi into a sample of an image. */
static float value_factor(const weft_dataset_layout *layout, int image)
{
    return layout->values == WEFT_REFLECTANCE_COSINE ? (float)layout->light[image].z : 1;
}

/* ---- The table ---- */

static bool read_valid(const weft_bard_plan *plan, const weft_dataset_layout *layout, const weft_half *samples,
                       const uint8_t *mask, weft_bard_texel *texel)
{
    bool is_any = false;
    for (int k = 0; k < plan->count; k++) {
        int image = plan->photograph[k];
        float factor = value_factor(layout, image);
        texel->is_valid[k] = !mask[image];
        is_any |= texel->is_valid[k];
        for (int c = 0; c < 3; c++)
            texel->specular[k][c] = weft_float_of_half(samples[3 * image + c]) / factor;
    }
    return is_any;
}

static int nearest_valid(const weft_bard_plan *plan, const weft_bard_texel *texel, int entry)
{
    int nearest = -1;
    weft_real largest_cosine = -2;
    for (int k = 0; k < plan->count; k++) {
        weft_real cosine = weft_dot(plan->view[k], plan->view[entry]);
        if (texel->is_valid[k] && cosine > largest_cosine) {
            largest_cosine = cosine;
            nearest = k;
        }
    }
    return nearest;
}

static void fill_masked(const weft_bard_plan *plan, weft_bard_texel *texel)
{
    for (int k = 0; k < plan->count; k++) {
        if (texel->is_valid[k])
            continue;
        memcpy(texel->specular[k], texel->specular[nearest_valid(plan, texel, k)], sizeof texel->specular[k]);
        texel->filled_count++;
    }
}

static void split_diffuse(const weft_bard_plan *plan, double share, weft_bard_texel *texel)
{
    for (int c = 0; c < 3; c++) {
        float least = texel->specular[0][c];
        for (int k = 1; k < plan->count; k++)
            least = fmin(least, texel->specular[k][c]);
        texel->diffuse[c] = (float)share * fmax(least, 0);
        for (int k = 0; k < plan->count; k++)
            texel->specular[k][c] -= texel->diffuse[c];
    }
}

void weft_bard_texel_measure(const weft_bard_plan *plan, const weft_dataset_layout *layout, double diffuse_share,
                             const weft_half *samples, const uint8_t *mask, weft_bard_texel *texel)
{
    texel->filled_count = 0;
    if (!read_valid(plan, layout, samples, mask, texel)) {
        texel->filled_count = -1;
        return;
    }
    fill_masked(plan, texel);
    split_diffuse(plan, diffuse_share, texel);
}

/* ---- Predictions ---- */

static void predict_image(const weft_bard_texel *texel, const weft_bard_mix *mix, float factor, weft_half sample[3])
{
    float sum[3] = {0};
    for (int i = 0; i < 3 && mix->at.index[i] >= 0; i++) {
        const float *specular = texel->specular[mix->at.index[i]];
        for (int c = 0; c < 3; c++)
            sum[c] += (float)mix->at.weight[i] * specular[c];
    }
    for (int c = 0; c < 3; c++) {
        float value = (texel->diffuse[c] + (float)mix->gain * sum[c]) * factor;
        sample[c] = weft_half_of_float(fmin(fmax(value, -largest_sample), largest_sample));
    }
}

void weft_bard_texel_predict(const weft_bard_plan *plan, const weft_dataset_layout *layout,
                             const weft_bard_texel *texel, weft_half *samples, uint8_t *mask)
{
    bool is_empty = texel->filled_count < 0;
    memset(samples, 0, 3 * (size_t)layout->image_count * sizeof *samples);
    memset(mask, is_empty ? WEFT_MASK_MISSING : 0, (size_t)layout->image_count);
    for (int i = 0; i < layout->image_count && !is_empty; i++) {
        if (plan->mix[i].gain > 0)
            predict_image(texel, &plan->mix[i], value_factor(layout, i), samples + 3 * i);
    }
}
