#include "compress/texel.h"

#include "compress/kernels.h"
#include "compress/pack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A frame is turned only where that takes at least 2 % off the squared error. */
#define WORTHWHILE 0.98

/* The fit of a few lights is a start, not worth its last steps. */
#define COARSE_TOLERANCE 3e-3

/* A fit of the grey samples and its T. */
typedef struct grey_fit {
    weft_fit fit;
    double *table;
} grey_fit;

struct weft_texel_fitter {
    const weft_texel_source *source;
    weft_bundle bundle;
    weft_samples samples;
    weft_fit_workspace *workspace;
    grey_fit upright, turned;
    double *table; /* of one channel */
    uint8_t *code;
    float *decoded; /* T as it will be read */
    const weft_fit_kernels *kernels;
    weft_error_tally *tally;
};

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
        fitter->upright.table = calloc(3 * views, sizeof *fitter->table);
        fitter->code = calloc(views, 1);
        fitter->decoded = calloc(views, sizeof *fitter->decoded);
        if (!fitter->upright.table || !fitter->code || !fitter->decoded)
            code = weft_fail_memory(error, "view tables of a texel", 3 * views * sizeof *fitter->table);
    }
    if (code != WEFT_OK) {
        weft_texel_fitter_free(fitter);
        return code;
    }
    fitter->turned.table = fitter->upright.table + views;
    fitter->table = fitter->upright.table + 2 * views;
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
    free(fitter->upright.table);
    free(fitter->code);
    free(fitter->decoded);
    free(fitter);
}

weft_error_tally *weft_texel_fitter_tally(weft_texel_fitter *fitter)
{
    return fitter->tally;
}

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

int weft_texel_group(const weft_dataset_layout *layout, int level, int x, int y, int extent[4])
{
    int side = 1 << level;
    extent[0] = x * side;
    extent[1] = y * side;
    extent[2] = smaller((x + 1) * side, layout->width);
    extent[3] = smaller((y + 1) * side, layout->height);
    return (extent[2] - extent[0]) * (extent[3] - extent[1]);
}

/* ---- The frame, by fits of the grey samples on a quarter of the lights ---- */

/* Which of two fits the channels start from: in the frame of the surface, or in one that was free to turn. */
static const grey_fit *choose_frame(weft_texel_fitter *fitter, const weft_fit_options *options,
                                    weft_texel_counts *counts)
{
    grey_fit *upright = &fitter->upright, *turned = &fitter->turned;
    weft_frame frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_fit_cold(&fitter->bundle, &fitter->samples, WEFT_GREY, options, fitter->workspace, &frame, &upright->fit,
                  upright->table);
    counts->second_start += upright->fit.start > 0;
    if (options->lobe_count == 0 || !fitter->source->fit_frames)
        return upright;
    weft_fit_options turning = *options;
    turning.fit_frame = true;
    turned->fit = upright->fit;
    memcpy(turned->table, upright->table, (size_t)fitter->bundle.view_count * sizeof *turned->table);
    weft_fit_refine(&fitter->bundle, &fitter->samples, WEFT_GREY, &turning, fitter->workspace, &turned->fit,
                    turned->table);
    bool turn = turned->fit.residual < WORTHWHILE * upright->fit.residual;
    counts->turned += turn;
    return turn ? turned : upright;
}

/* ---- Storing and measuring ---- */

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

/* In a level of many texels this share of them is enough for percentiles. */
enum { TALLIED_TEXELS = 1024 };

static bool is_tallied(const weft_material_level *level, int x, int y)
{
    int stride = level->width * level->height / TALLIED_TEXELS;
    return stride < 2 || (y * level->width + x) % stride == 0;
}

static void tally_channel(weft_texel_fitter *fitter, int channel, const float *model, const float *table)
{
    const weft_bundle *bundle = &fitter->bundle;
    const weft_samples *samples = &fitter->samples;
    for (int i = 0; i < bundle->sample_count; i++) {
        float cosine = samples->cosine[i];
        if (!(cosine > 0))
            continue;
        float scale = (float)samples->scale * bundle->light[2][i] / cosine;
        weft_error_tally_add(fitter->tally, samples->value[channel][i] * scale,
                             model[i] * table[bundle->view_of[i]] * scale);
    }
}

/* The material as it will be read, against the samples. */
static void measure_channel(weft_texel_fitter *fitter, int channel, const weft_fit *fit, bool table, bool tallied,
                            weft_error_sums *sums)
{
    const weft_bundle *bundle = &fitter->bundle;
    const float *model = weft_fit_evaluate(bundle, &fitter->samples, fitter->workspace, fit);
    for (int view = 0; view < bundle->view_count; view++)
        fitter->decoded[view] = table ? (float)weft_table_of_code(fitter->code[view]) : 1;
    fitter->kernels->compare(bundle, &fitter->samples, channel, model, fitter->decoded, sums);
    if (tallied)
        tally_channel(fitter, channel, model, fitter->decoded);
}

static void fit_channel(weft_texel_fitter *fitter, const weft_fit_options *options, int channel, const grey_fit *start,
                        const weft_frame *frame, weft_material *material, int level, int x, int y,
                        weft_error_sums *sums)
{
    weft_fit fit = start->fit;
    weft_packed packed;
    fit.frame = *frame;
    memcpy(fitter->table, start->table, (size_t)fitter->bundle.view_count * sizeof *fitter->table);
    weft_fit_refine(&fitter->bundle, &fitter->samples, channel, options, fitter->workspace, &fit, fitter->table);
    weft_pack_channel(&fitter->bundle, &fitter->samples, channel, options, fitter->workspace, &fit, fitter->table,
                      &packed, fitter->code);
    weft_texel_store(material, level, x, y, channel, &packed, options->table ? fitter->code : NULL);
    fit = weft_unpack(&packed, options->lobe_count, frame, fitter->samples.scale);
    measure_channel(fitter, channel, &fit, options->table, is_tallied(&material->level[level], x, y), sums);
}

void weft_texel_fit(weft_texel_fitter *fitter, weft_material *material, int level, int x, int y, const float *sum,
                    const float *count, weft_texel_counts *counts)
{
    const weft_dataset_layout *layout = fitter->source->layout;
    weft_fit_options options = fitter->source->options;
    int extent[4], group = weft_texel_group(layout, level, x, y, extent);
    if (layout->distance == WEFT_NEAR) {
        double x_mm, y_mm;
        weft_bundle_place(layout, extent[0], extent[1], extent[2], extent[3], &x_mm, &y_mm);
        weft_bundle_aim(&fitter->bundle, layout, x_mm, y_mm);
    }
    weft_samples_gather(&fitter->bundle, layout->values, sum, count, group, &fitter->samples);
    options.lobe_count =
        weft_fit_affordable_lobes(&fitter->bundle, &fitter->samples, options.lobe_count, options.table);
    weft_fit_options coarse = options;
    coarse.coarse = true;
    coarse.tolerance = COARSE_TOLERANCE;
    const grey_fit *start = choose_frame(fitter, &coarse, counts);
    counts->texels++;
    counts->empty += fitter->samples.valid_count == 0;
    size_t texel = (size_t)y * (size_t)material->level[level].width + (size_t)x;
    weft_frame frame = weft_pack_frame(&start->fit.frame, material->level[level].frame + 3 * texel);
    for (int channel = 0; channel < WEFT_CHANNELS; channel++)
        fit_channel(fitter, &options, channel, start, &frame, material, level, x, y, &counts->sums);
}
