#include "compress/sparse/sparse.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The texel in the terms of a dense fit. */
static weft_fit fit_of_texel(const weft_sparse_texel *texel, int lobe_count, int channel)
{
    weft_vec3 normal = weft_unit(weft_vec3_of((double)texel->slope_x, (double)texel->slope_y, 1));
    weft_fit fit = {
        .diffuse = (double)texel->diffuse[channel], .lobe_count = lobe_count, .frame = weft_frame_of_normal(normal, 0)};
    if (lobe_count > 0)
        fit.lobe[0] = (weft_fit_lobe){.c = {-1, -1, 1},
                                      .log_exponent = log(fmax((double)texel->exponent, 1)),
                                      .amplitude = (double)texel->amplitude[channel]};
    return fit;
}

/* f cos of the stored texel. */
static float decoded_value(const weft_fit *fit, const float *light, const float *view)
{
    weft_vec3 l = weft_vec3_of((double)light[0], (double)light[1], (double)light[2]);
    weft_vec3 v = weft_vec3_of((double)view[0], (double)view[1], (double)view[2]);
    double sum = fit->diffuse;
    for (int i = 0; i < fit->lobe_count; i++) {
        const weft_fit_lobe *lobe = &fit->lobe[i];
        const weft_frame *frame = &fit->frame;
        double base = lobe->c[0] * weft_dot(frame->tangent, l) * weft_dot(frame->tangent, v) +
                      lobe->c[1] * weft_dot(frame->bitangent, l) * weft_dot(frame->bitangent, v) +
                      lobe->c[2] * weft_dot(frame->normal, l) * weft_dot(frame->normal, v);
        sum += base > 0 ? lobe->amplitude * pow(base, exp(lobe->log_exponent)) : 0;
    }
    return (float)(l.z * sum);
}

static void measure_texel(const weft_sparse_field *field, size_t texel, int channel, const weft_fit *fit,
                          weft_error_tally *tally, weft_error_sums *sums)
{
    size_t images = (size_t)field->image_count;
    for (size_t i = texel * images; i < (texel + 1) * images; i++) {
        if (!(field->weight[i] > 0))
            continue;
        float sample = field->value[3 * i + (size_t)channel];
        float prediction = decoded_value(fit, field->light + 3 * i, field->view + 3 * i);
        weft_error_tally_add(tally, sample, prediction);
        sums->square += (double)sample * (double)sample;
        sums->square_error += (double)(sample - prediction) * (double)(sample - prediction);
        sums->count += 1;
    }
}

/* See compress/texel/texel.h. */
static double ceiling_of(const weft_sparse_field *field, size_t texel)
{
    size_t images = (size_t)field->image_count;
    double r = 0, f = 0, highest = 0;
    for (size_t i = texel * images; i < (texel + 1) * images; i++) {
        const float *value = field->value + 3 * i;
        double cosine = (double)field->light[3 * i + 2];
        double brightest = fmax((double)value[0], fmax((double)value[1], (double)value[2]));
        if (!(field->weight[i] > 0 && cosine > 0))
            continue;
        r = fmax(r, brightest);
        f = fmax(f, brightest / cosine);
        highest = fmax(highest, cosine);
    }
    return weft_texel_ceiling(r, f, highest);
}

static bool has_samples(const weft_sparse_field *field, size_t texel)
{
    size_t images = (size_t)field->image_count;
    for (size_t i = texel * images; i < (texel + 1) * images; i++) {
        if (field->weight[i] > 0)
            return true;
    }
    return false;
}

static void store_texel(const weft_sparse_field *field, const weft_sparse_texel *from, size_t texel,
                        weft_material *material, int level, weft_error_tally *tally, weft_texel_counts *counts)
{
    int x = (int)(texel % (size_t)field->width), y = (int)(texel / (size_t)field->width);
    weft_frame frame = fit_of_texel(from, 0, 0).frame;
    frame = weft_pack_frame(&frame, material->level[level].frame + 3 * texel);
    for (int channel = 0; channel < WEFT_CHANNELS; channel++) {
        weft_fit fit = fit_of_texel(from, material->lobe_count, channel);
        weft_packed packed;
        weft_pack_rounded(&fit, 1, &packed);
        weft_texel_store(material, level, x, y, channel, &packed, NULL);
        fit = weft_unpack(&packed, material->lobe_count, &frame, 1);
        measure_texel(field, texel, channel, &fit, tally, &counts->sums);
    }
    weft_material_set_ceiling(&material->level[level], texel, (float)ceiling_of(field, texel));
    counts->texels++;
    counts->empty += !has_samples(field, texel);
}

static weft_code fit_level(const weft_sparse_field *field, const weft_sparse_setting *setting, weft_material *material,
                           int level, weft_texel_counts *counts, weft_error *error)
{
    size_t texels = (size_t)field->width * (size_t)field->height;
    weft_error_tally *tally = NULL;
    weft_texel_counts own = {0};
    weft_sparse_texel *fitted = malloc(texels * sizeof *fitted);
    weft_code code = fitted ? weft_sparse_fit(field, setting, fitted, error)
                            : weft_fail_memory(error, "texels", texels * sizeof *fitted);
    if (code == WEFT_OK)
        code = weft_error_tally_create(&tally, error);
    if (code == WEFT_OK) {
        for (size_t texel = 0; texel < texels; texel++)
            store_texel(field, &fitted[texel], texel, material, level, tally, &own);
        material->level[level].error = weft_error_tally_summarise(tally, &own.sums);
        counts->texels += own.texels;
        counts->empty += own.empty;
    }
    weft_error_tally_free(tally);
    free(fitted);
    return code;
}

weft_code weft_sparse_material_fit(weft_dataset *dataset, const uint8_t *held_out, const weft_progress *progress,
                                   weft_material *material, weft_sparse_setting *setting, weft_texel_counts *counts,
                                   long *masked_count, weft_error *error)
{
    weft_sparse_field field;
    *counts = (weft_texel_counts){0};
    WEFT_TRY(weft_sparse_field_read(dataset, held_out, &field, masked_count, error));
    weft_progress_report(progress, "fitting levels", 0, material->level_count);
    weft_code code = weft_sparse_choose(&field, material->lobe_count > 0, setting, error);
    for (int level = 0; code == WEFT_OK && level < material->level_count; level++) {
        weft_sparse_field next = {0};
        code = fit_level(&field, setting, material, level, counts, error);
        if (code == WEFT_OK && level + 1 < material->level_count)
            code = weft_sparse_field_halve(&field, &next, error);
        weft_sparse_field_free(&field);
        field = next;
        weft_progress_report(progress, "fitting levels", level + 1, material->level_count);
    }
    weft_sparse_field_free(&field);
    return code;
}
