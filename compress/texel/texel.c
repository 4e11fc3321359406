#include "compress/texel/texel.h"

#include "base/integers.h"
#include "compress/fit/kernels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* In a level of many texels this share of them is enough for percentiles. */
enum { TALLIED_TEXELS = 1024 };

/* The fit of the grey samples is a start, not worth its last steps: it is found with few lights and then refined with
 * all. */
#define GREY_TOLERANCE 3e-3

/* How much brighter, as a root mean square, a view without samples may be than the nearest one with: facing the rim of
 * the hemisphere, cloth is brighter indeed. */
#define MOST_BRIGHTER 1.5

struct weft_texel_fitter {
    const weft_texel_source *source;
    weft_bundle bundle;
    weft_samples samples;
    weft_fit_workspace *workspace;
    double *table;         /* [2][view_count] T of one channel; then room */
    double *grey_table[2]; /* [view_count] T of the best fit of the grey samples, and of another one */
    int *seen;             /* [view_count] valid samples */
    float *decoded;        /* [view_count] T of one channel as it will be read */
    weft_error_tally *tally;
    /* The texel as it is stored, and as it will be read: */
    int16_t frame[3];
    weft_packed packed[WEFT_CHANNELS];
    weft_fit as_read[WEFT_CHANNELS];
    uint8_t *code; /* [channel][view_count] of T */
};

weft_code weft_texel_fitter_create(const weft_texel_source *source, weft_texel_fitter **result, weft_error *error)
{
    *result = NULL;
    weft_texel_fitter *fitter = calloc(1, sizeof *fitter);
    if (!fitter)
        return weft_fail_memory(error, "texel fitter", sizeof *fitter);
    fitter->source = source;
    size_t views = (size_t)source->layout->view_count;
    weft_code code = weft_bundle_create(source->layout, source->held_out, &fitter->bundle, error);
    if (code == WEFT_OK)
        code = weft_samples_create(&fitter->bundle, &fitter->samples, error);
    if (code == WEFT_OK)
        code = weft_fit_workspace_create(&fitter->bundle, &fitter->workspace, error);
    if (code == WEFT_OK)
        code = weft_error_tally_create(&fitter->tally, error);
    if (code == WEFT_OK) {
        fitter->table = calloc(4 * views, sizeof *fitter->table);
        fitter->seen = calloc(views, sizeof *fitter->seen);
        fitter->code = calloc(WEFT_CHANNELS * views, 1);
        fitter->decoded = calloc(views, sizeof *fitter->decoded);
        if (!fitter->table || !fitter->seen || !fitter->code || !fitter->decoded)
            code = weft_fail_memory(error, "view tables of a texel", views * sizeof *fitter->table);
    }
    if (code != WEFT_OK) {
        weft_texel_fitter_free(fitter);
        return code;
    }
    for (size_t i = 0; i < 2; i++)
        fitter->grey_table[i] = fitter->table + (2 + i) * views;
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

/* ---- Views that do not see the texel ----
 *
 * Of the texels beside a frame, say, those that look across it. */

/* Valid samples by view; returns whether some view has none. */
static bool count_samples(weft_texel_fitter *fitter)
{
    const weft_bundle *bundle = &fitter->bundle;
    memset(fitter->seen, 0, (size_t)bundle->view_count * sizeof *fitter->seen);
    for (int i = 0; i < bundle->sample_count; i++)
        fitter->seen[bundle->view_of[i]] += fitter->samples.cosine[i] > 0;
    for (int view = 0; view < bundle->view_count; view++) {
        if (fitter->seen[view] == 0)
            return true;
    }
    return false;
}

static int nearest_seen(const weft_texel_fitter *fitter, int view)
{
    const weft_bundle *bundle = &fitter->bundle;
    int nearest = -1;
    for (int other = 0; other < bundle->view_count; other++) {
        if (fitter->seen[other] > 0 && (nearest < 0 || weft_dot(bundle->view[view], bundle->view[other]) >
                                                           weft_dot(bundle->view[view], bundle->view[nearest])))
            nearest = other;
    }
    return nearest;
}

/* Mean square of the model without T over all lights of a view, masked or not. */
static void measure_views(weft_texel_fitter *fitter, int channel)
{
    const weft_bundle *bundle = &fitter->bundle;
    weft_samples all = fitter->samples;
    all.cosine = bundle->light[2];
    const float *model = weft_fit_evaluate(bundle, &all, fitter->workspace, &fitter->as_read[channel]);
    double *energy = fitter->table, *count = energy + bundle->view_count;
    memset(energy, 0, 2 * (size_t)bundle->view_count * sizeof *energy);
    for (int i = 0; i < bundle->sample_count; i++) {
        if (bundle->image[i] < 0 || !(all.cosine[i] > 0))
            continue;
        energy[bundle->view_of[i]] += (double)model[i] * (double)model[i];
        count[bundle->view_of[i]]++;
    }
    for (int view = 0; view < bundle->view_count; view++)
        energy[view] /= fmax(count[view], 1);
}

/* T of a channel is the mean of the others in views without any valid sample. Lowers its code where the model, whose
 * lobes were fitted to the others and may be of any size there, would be far brighter than in the nearest view with
 * samples. */
static void limit_unseen(weft_texel_fitter *fitter, int channel)
{
    const weft_bundle *bundle = &fitter->bundle;
    uint8_t *code = fitter->code + (size_t)channel * (size_t)bundle->view_count;
    if (fitter->samples.valid_count == bundle->image_count || !count_samples(fitter))
        return;
    measure_views(fitter, channel);
    for (int view = 0; view < bundle->view_count; view++) {
        int nearest = fitter->seen[view] == 0 ? nearest_seen(fitter, view) : -1;
        if (nearest < 0)
            continue;
        double own = fitter->table[view], other = fitter->table[nearest];
        double most = own > 0 ? MOST_BRIGHTER * weft_table_of_code(code[nearest]) * sqrt(other / own) : 1;
        code[view] = weft_code_of_table(fmin(weft_table_of_code(code[view]), most));
    }
}

/* ---- The fit ---- */

/* Fits the grey samples, beginning in `frame`; where it leaves less than `best` it becomes that. */
static void try_frame(weft_texel_fitter *fitter, const weft_fit_options *options, weft_frame frame, weft_fit *best)
{
    weft_fit fit;
    weft_fit_cold(&fitter->bundle, &fitter->samples, WEFT_GREY, options, fitter->workspace, &frame, &fit,
                  fitter->grey_table[1]);
    if (!(fit.residual < best->residual))
        return;
    double *table = fitter->grey_table[0];
    fitter->grey_table[0] = fitter->grey_table[1];
    fitter->grey_table[1] = table;
    *best = fit;
}

/* The fit of the grey samples from the frame of the surface, and from the one that the texel is given. Its frame is
 * that of all channels: frames of their own would take thrice the time and three frames to store. */
static weft_fit fit_grey(weft_texel_fitter *fitter, const weft_fit_options *options, int level, int x, int y)
{
    const weft_material *given = fitter->source->given;
    weft_fit_options grey = *options;
    weft_fit best = {.residual = INFINITY};
    grey.tolerance = GREY_TOLERANCE;
    grey.fit_frame = true;
    grey.coarse = fitter->bundle.is_coarse;
    try_frame(fitter, &grey, weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0), &best);
    if (given && options->lobe_count > 0) {
        const weft_material_level *from = &given->level[level];
        size_t texel = (size_t)y * (size_t)from->width + (size_t)x;
        try_frame(fitter, &grey, weft_frame_decode(from->frame + 3 * texel), &best);
    }
    if (grey.coarse) {
        grey.coarse = false;
        grey.fit_frame = best.has_turned;
        weft_fit_refine(&fitter->bundle, &fitter->samples, WEFT_GREY, &grey, fitter->workspace, &best,
                        fitter->grey_table[0]);
    }
    return best;
}

static void fit_channel(weft_texel_fitter *fitter, const weft_fit_options *options, int channel, const weft_fit *start)
{
    size_t views = (size_t)fitter->bundle.view_count;
    uint8_t *code = fitter->code + (size_t)channel * views;
    weft_fit fit = *start;
    memcpy(fitter->table, fitter->grey_table[0], views * sizeof *fitter->table);
    memset(code, 255, views);
    weft_fit_refine(&fitter->bundle, &fitter->samples, channel, options, fitter->workspace, &fit, fitter->table);
    weft_pack_channel(&fitter->bundle, &fitter->samples, channel, options, fitter->workspace, &fit, fitter->table,
                      &fitter->packed[channel], code);
    fitter->as_read[channel] =
        weft_unpack(&fitter->packed[channel], options->lobe_count, &fit.frame, fitter->samples.scale);
    if (options->table)
        limit_unseen(fitter, channel);
}

/* ---- The error ---- */

static void tally_channel(weft_texel_fitter *fitter, int channel, const float *model)
{
    const weft_bundle *bundle = &fitter->bundle;
    const weft_samples *samples = &fitter->samples;
    for (int i = 0; i < bundle->sample_count; i++) {
        float cosine = samples->cosine[i];
        if (!(cosine > 0))
            continue;
        float scale = (float)samples->scale * bundle->light[2][i] / cosine;
        weft_error_tally_add(fitter->tally, samples->value[channel][i] * scale,
                             model[i] * fitter->decoded[bundle->view_of[i]] * scale);
    }
}

/* How far the texel, as it will be read, is from its samples; `tallied`: also for the percentiles. */
static weft_error_sums measure(weft_texel_fitter *fitter, bool tallied)
{
    const weft_bundle *bundle = &fitter->bundle;
    weft_error_sums sums = {0};
    for (int channel = 0; channel < WEFT_CHANNELS; channel++) {
        const uint8_t *code = fitter->code + (size_t)channel * (size_t)bundle->view_count;
        for (int view = 0; view < bundle->view_count; view++)
            fitter->decoded[view] = (float)weft_table_of_code(code[view]);
        const float *model = weft_fit_evaluate(bundle, &fitter->samples, fitter->workspace, &fitter->as_read[channel]);
        WEFT_DISPATCH(weft_gather_compare)(bundle, &fitter->samples, channel, model, fitter->decoded, &sums);
        if (tallied)
            tally_channel(fitter, channel, model);
    }
    return sums;
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
        WEFT_DISPATCH(weft_gather_brightest)(&fitter->bundle, &fitter->samples, channel, &r, &f, &cosine);
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
    gather(fitter, level, x, y, sum, count);
    options.lobe_count =
        weft_fit_affordable_lobes(&fitter->bundle, &fitter->samples, options.lobe_count, options.table);
    weft_fit start = fit_grey(fitter, &options, level, x, y);
    start.frame = weft_pack_frame(&start.frame, fitter->frame);
    for (int channel = 0; channel < WEFT_CHANNELS; channel++)
        fit_channel(fitter, &options, channel, &start);
    weft_error_sums sums = measure(fitter, is_tallied(&material->level[level], x, y));
    weft_error_sums_add(&counts->sums, &sums);
    store(fitter, material, level, x, y);
    counts->texels++;
    counts->empty += fitter->samples.valid_count == 0;
}
