#include "base/integers.h"
#include "compress/texel/parts.h"

#include <stdlib.h>
#include <string.h>

/* In a level of many texels this share of them is enough for percentiles. */
enum { TALLIED_TEXELS = 1024 };

weft_code weft_texel_fitter_create(const weft_texel_source *source, weft_texel_fitter **result, weft_error *error)
{
    *result = NULL;
    weft_texel_fitter *fitter = calloc(1, sizeof *fitter);
    if (!fitter)
        return weft_fail_memory(error, "texel fitter", sizeof *fitter);
    fitter->source = source;
    fitter->kernels = weft_fit_kernels_of(weft_processor_instruction_set());
    size_t views = (size_t)source->layout->view_count;
    weft_code code = weft_bundle_create(source->layout, source->held_out, &fitter->bundle, error);
    if (code == WEFT_OK)
        code = weft_samples_create(&fitter->bundle, &fitter->samples, error);
    if (code == WEFT_OK)
        code = weft_fit_workspace_create(&fitter->bundle, &fitter->workspace, error);
    if (code == WEFT_OK)
        code = weft_error_tally_create(&fitter->tally, error);
    if (code == WEFT_OK) {
        fitter->table = calloc(2 * views, sizeof *fitter->table);
        fitter->seen = calloc(views, sizeof *fitter->seen);
        fitter->code = calloc(WEFT_CHANNELS * views, 1);
        fitter->decoded = calloc(views, sizeof *fitter->decoded);
        if (!fitter->table || !fitter->seen || !fitter->code || !fitter->decoded)
            code = weft_fail_memory(error, "view tables of a texel", views * sizeof *fitter->table);
    }
    if (code == WEFT_OK)
        code = weft_frame_search_create(source->layout->view_count, &fitter->search, error);
    if (code != WEFT_OK) {
        weft_texel_fitter_free(fitter);
        return code;
    }
    *result = fitter;
    return WEFT_OK;
}

void weft_texel_fitter_free(weft_texel_fitter *fitter)
{
    if (!fitter)
        return;
    weft_bundle_free(&fitter->bundle);
    weft_samples_free(&fitter->samples);
    weft_fit_workspace_free(fitter->workspace);
    weft_error_tally_free(fitter->tally);
    weft_frame_search_free(&fitter->search);
    free(fitter->table);
    free(fitter->seen);
    free(fitter->code);
    free(fitter->decoded);
    free(fitter);
}

weft_error_tally *weft_texel_fitter_tally(weft_texel_fitter *fitter)
{
    return fitter->tally;
}

/* ---- The samples ---- */

int weft_texel_group(const weft_dataset_layout *layout, int level, int x, int y, int extent[4])
{
    int side = 1 << level;
    extent[0] = x * side;
    extent[1] = y * side;
    extent[2] = weft_smaller((x + 1) * side, layout->width);
    extent[3] = weft_smaller((y + 1) * side, layout->height);
    return (extent[2] - extent[0]) * (extent[3] - extent[1]);
}

static void gather(weft_texel_fitter *fitter, int level, int x, int y, const float *sum, const float *count)
{
    const weft_dataset_layout *layout = fitter->source->layout;
    int extent[4], group = weft_texel_group(layout, level, x, y, extent);
    if (layout->distance == WEFT_NEAR) {
        double x_mm, y_mm;
        weft_bundle_place(layout, extent[0], extent[1], extent[2], extent[3], &x_mm, &y_mm);
        weft_bundle_aim(&fitter->bundle, layout, x_mm, y_mm);
    }
    weft_samples_gather(&fitter->bundle, layout->values, sum, count, group, &fitter->samples);
    if (fitter->source->weights == WEFT_WEIGHTS_SCREEN)
        weft_samples_weigh_for_screen(&fitter->bundle, &fitter->samples);
}

/* ---- The fit ---- */

/* The frame that a texel is given; NULL where there is none. */
static const weft_frame *find_given(const weft_material *given, int level, int x, int y, weft_frame *frame)
{
    if (!given)
        return NULL;
    const weft_material_level *from = &given->level[level];
    *frame = weft_frame_decode(from->frame + 3 * ((size_t)y * (size_t)from->width + (size_t)x));
    return frame;
}

static void fit_channel(weft_texel_fitter *fitter, const weft_fit_options *options, int channel,
                        const weft_grey_fit *start, const weft_frame *frame)
{
    size_t views = (size_t)fitter->bundle.view_count;
    uint8_t *code = fitter->code + (size_t)channel * views;
    weft_fit fit = start->fit;
    fit.frame = *frame;
    memcpy(fitter->table, start->table, views * sizeof *fitter->table);
    memset(code, 255, views);
    weft_fit_refine(&fitter->bundle, &fitter->samples, channel, options, fitter->workspace, &fit, fitter->table);
    weft_pack_channel(&fitter->bundle, &fitter->samples, channel, options, fitter->workspace, &fit, fitter->table,
                      &fitter->packed[channel], code);
    fitter->as_read[channel] = weft_unpack(&fitter->packed[channel], options->lobe_count, frame, fitter->samples.scale);
    if (options->table)
        weft_texel_limit_unseen(fitter, channel);
}

/* ---- Storing ---- */

double weft_texel_ceiling(double r, double f, double cosine)
{
    double bound = cosine > 0 ? WEFT_BRIGHTEST_MULTIPLE * r / cosine : 0;
    return f > bound ? f : bound;
}

void weft_texel_store(weft_material *material, int level, int x, int y, int channel, const weft_packed *packed,
                      const uint8_t *code)
{
    weft_material_level *to = &material->level[level];
    size_t texels = (size_t)to->width * (size_t)to->height, texel = (size_t)y * (size_t)to->width + (size_t)x;
    to->diffuse[4 * texel + (size_t)channel] = packed->diffuse;
    for (int i = 0; i < material->lobe_count; i++) {
        size_t at = ((size_t)(3 * i + channel) * texels + texel) * 4;
        memcpy(to->lobe + at, packed->lobe[i], sizeof packed->lobe[i]);
    }
    for (int view = 0; code && view < material->view_count; view++)
        to->table[((size_t)view * texels + texel) * 4 + (size_t)channel] = code[view];
}

static void store(const weft_texel_fitter *fitter, weft_material *material, int level, int x, int y)
{
    weft_material_level *to = &material->level[level];
    size_t texel = (size_t)y * (size_t)to->width + (size_t)x;
    double most_r = 0, most_f = 0, highest = 0;
    memcpy(to->frame + 3 * texel, fitter->frame, sizeof fitter->frame);
    for (int channel = 0; channel < WEFT_CHANNELS; channel++) {
        float r, f, cosine;
        weft_texel_store(material, level, x, y, channel, &fitter->packed[channel],
                         fitter->code + (size_t)channel * (size_t)fitter->bundle.view_count);
        fitter->kernels->brightest(&fitter->bundle, &fitter->samples, channel, &r, &f, &cosine);
        most_r = (double)r > most_r ? (double)r : most_r;
        most_f = (double)f > most_f ? (double)f : most_f;
        highest = (double)cosine > highest ? (double)cosine : highest;
    }
    weft_material_set_ceiling(to, texel, (float)(fitter->samples.scale * weft_texel_ceiling(most_r, most_f, highest)));
}

static bool is_tallied(const weft_material_level *level, int x, int y)
{
    int stride = level->width * level->height / TALLIED_TEXELS;
    return stride < 2 || (y * level->width + x) % stride == 0;
}

/* ---- The whole ---- */

void weft_texel_fit(weft_texel_fitter *fitter, weft_material *material, int level, int x, int y, const float *sum,
                    const float *count, weft_texel_counts *counts)
{
    weft_fit_options options = fitter->source->options;
    weft_frame given_frame;
    gather(fitter, level, x, y, sum, count);
    options.lobe_count =
        weft_fit_affordable_lobes(&fitter->bundle, &fitter->samples, options.lobe_count, options.table);
    const weft_grey_fit start =
        weft_frame_search_run(&fitter->search, &fitter->bundle, &fitter->samples, fitter->workspace, &options,
                              find_given(fitter->source->given, level, x, y, &given_frame));
    const weft_frame frame = weft_pack_frame(&start.fit.frame, fitter->frame);
    for (int channel = 0; channel < WEFT_CHANNELS; channel++)
        fit_channel(fitter, &options, channel, &start, &frame);
    weft_error_sums sums = weft_texel_measure(fitter, is_tallied(&material->level[level], x, y));
    weft_error_sums_add(&counts->sums, &sums);
    store(fitter, material, level, x, y);
    counts->texels++;
    counts->empty += fitter->samples.valid_count == 0;
    counts->turned += start.turns;
    counts->second_start += start.fit.start > 0;
}
