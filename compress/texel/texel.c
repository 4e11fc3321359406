#include "base/integers.h"
#include "compress/texel/model_ladder.h"
#include "compress/texel/parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
        fitter->now.code = calloc(WEFT_CHANNELS * views, 1);
        fitter->kept.code = calloc(WEFT_CHANNELS * views, 1);
        fitter->factor = calloc(2 * views, sizeof *fitter->factor);
        fitter->decoded = calloc(views, sizeof *fitter->decoded);
        if (!fitter->table || !fitter->seen || !fitter->now.code || !fitter->kept.code || !fitter->factor ||
            !fitter->decoded)
            code = weft_fail_memory(error, "view tables of a texel", views * sizeof *fitter->table);
    }
    if (code == WEFT_OK)
        code = weft_frame_search_create(source->layout->view_count, &fitter->frames, error);
    if (code == WEFT_OK && source->light_table)
        code = weft_texel_light_create(fitter, error);
    if (code == WEFT_OK)
        code = weft_texel_hold_create(fitter, error);
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
    weft_frame_search_free(&fitter->frames);
    free(fitter->table);
    free(fitter->seen);
    free(fitter->now.code);
    free(fitter->kept.code);
    free(fitter->factor);
    weft_texel_hold_free(fitter);
    free(fitter->decoded);
    weft_texel_light_free(fitter);
    free(fitter);
}

weft_error_tally *weft_texel_fitter_tally(weft_texel_fitter *fitter)
{
    return fitter->tally;
}

int weft_texel_group(const weft_dataset_layout *layout, int level, int x, int y, int extent[4])
{
    int side = 1 << level;
    extent[0] = x * side;
    extent[1] = y * side;
    extent[2] = weft_smaller((x + 1) * side, layout->width);
    extent[3] = weft_smaller((y + 1) * side, layout->height);
    return (extent[2] - extent[0]) * (extent[3] - extent[1]);
}

void weft_texel_store(weft_material *material, int level, int x, int y, int channel, const weft_packed *packed,
                      const uint8_t *code, const uint8_t *light_code)
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
    for (int light = 0; light_code && light < material->light_count; light++)
        to->light_table[((size_t)light * texels + texel) * 4 + (size_t)channel] = light_code[light];
}

static void store_model(const weft_texel_fitter *fitter, weft_material *material, int level, int x, int y)
{
    size_t texel = (size_t)y * (size_t)material->level[level].width + (size_t)x;
    memcpy(material->level[level].frame + 3 * texel, fitter->now.frame, sizeof fitter->now.frame);
    for (int channel = 0; channel < WEFT_CHANNELS; channel++)
        weft_texel_store(material, level, x, y, channel, &fitter->now.packed[channel],
                         fitter->now.code + (size_t)channel * (size_t)fitter->bundle.view_count,
                         fitter->light_count ? fitter->now.light_code + channel * fitter->light_count : NULL);
}

/* ---- One model ---- */

static void fit_channel(weft_texel_fitter *fitter, const weft_fit_options *options, bool light, int channel,
                        const weft_grey_fit *start, const weft_frame *frame)
{
    size_t views = (size_t)fitter->bundle.view_count;
    uint8_t *code = fitter->now.code + (size_t)channel * views;
    weft_fit fit = start->fit;
    fit.frame = *frame;
    memcpy(fitter->table, start->table, views * sizeof *fitter->table);
    memset(code, 255, views);
    if (fitter->light_count > 0)
        memset(fitter->now.light_code + (size_t)channel * (size_t)fitter->light_count, 255,
               (size_t)fitter->light_count);
    if (light)
        weft_texel_light_refine(fitter, options, channel, &fit);
    else
        weft_fit_refine(&fitter->bundle, &fitter->samples, channel, options, fitter->workspace, &fit, fitter->table);
    fitter->now.residual += fit.residual;
    weft_samples lit = weft_texel_samples_as_lit(fitter, channel);
    weft_pack_channel(&fitter->bundle, &lit, channel, options, fitter->workspace, &fit, fitter->table,
                      &fitter->now.packed[channel], code);
    fitter->now.as_read[channel] =
        weft_unpack(&fitter->now.packed[channel], options->lobe_count, frame, fitter->samples.scale);
    if (options->table)
        weft_texel_limit_unseen(fitter, channel);
}

static weft_frame_request request_of(const weft_texel_fitter *fitter, const weft_fit_options *options,
                                     const weft_frame *given)
{
    return (weft_frame_request){fitter->source->frames, given, *options, fitter->most_lobes};
}

/* The grey fit, without S, that a model begins from: the best of the refined starts. */
static const weft_grey_fit *find_start(weft_texel_fitter *fitter, const weft_fit_options *options,
                                       const weft_frame *given)
{
    weft_frame_request request = request_of(fitter, options, given);
    weft_frame_search_run(&fitter->frames, &fitter->bundle, &fitter->samples, fitter->workspace, &request);
    return &fitter->frames.best;
}

/* Another; NULL where there is none. */
static const weft_grey_fit *find_other(weft_texel_fitter *fitter, const weft_fit_options *options,
                                       const weft_frame *given)
{
    weft_frame_request request = request_of(fitter, options, given);
    bool found =
        weft_frame_search_other(&fitter->frames, &fitter->bundle, &fitter->samples, fitter->workspace, &request);
    return found ? &fitter->frames.other : NULL;
}

/* Fits and packs one model, with S or without, from its start; `fitter` holds the result, which may yet glare. Stops at
 * the channel with which what is left before rounding reaches `most`, and returns false. */
static bool fit_from(weft_texel_fitter *fitter, const weft_fit_options *options, bool light, const weft_grey_fit *start,
                     double most)
{
    if (light)
        start = weft_texel_light_start(fitter, options, start);
    fitter->now.turns =
        start->turns || (light && options->lobe_count > 0 && fitter->source->frames == WEFT_FRAMES_FITTED);
    fitter->now.second_start = start->fit.start > 0;
    fitter->now.held = false;
    fitter->now.residual = 0;
    weft_frame frame = weft_pack_frame(&start->fit.frame, fitter->now.frame);
    for (int channel = 0; channel < WEFT_CHANNELS && !(fitter->now.residual >= most); channel++)
        fit_channel(fitter, options, light, channel, start, &frame);
    return !(fitter->now.residual >= most);
}

static void hold(weft_texel_fitter *fitter, const weft_fit_options *options)
{
    for (int channel = 0; channel < WEFT_CHANNELS; channel++)
        weft_texel_hold(fitter, channel, options);
}

static void fit_model(weft_texel_fitter *fitter, const weft_fit_options *options, bool light, const weft_frame *given)
{
    fit_from(fitter, options, light, find_start(fitter, options, given), INFINITY);
    hold(fitter, options);
}

/* ---- The best model ---- */

/* A fit may end in a lesser minimum than that of a smaller model, rounding may spoil it, and it may have been held.
 * Hardly ever where there are so many samples, the grey fit leaves so much less than that of the smaller model, and
 * rounding cost next to nothing. */
enum { MANY_SAMPLES = 2000 };
#define CLEARLY_LESS 0.97
#define CLEARLY_LESS_BARE 0.9 /* without T beside a whole that has it: often a second start mends such a fit */
#define CLEARLY_LESS_LIT 0.7  /* where S is to be fitted, of which the grey fit knows nothing */
#define BARELY_MORE 1.01

static void swap_results(weft_texel_fitter *fitter)
{
    weft_texel_result now = fitter->now;
    fitter->now = fitter->kept;
    fitter->kept = now;
}

/* A model of the texel and what the last ones of its kind left. */
typedef struct contest {
    double least;      /* squared error of the best, as it will be read */
    double grey;       /* of the grey fit that the whole model began from */
    bool is_sure;      /* that only a grey fit which leaves about as much needs a look */
    bool stepped_down; /* the best is not the whole model */
} contest;

/* Fits a model from one start, and keeps the better one; returns whether another start may do better: it was held,
 * spoilt by rounding, or left too much. A model that leaves too much before it is rounded and held leaves more
 * afterwards. */
static bool try_start(weft_texel_fitter *fitter, const weft_fit_options *options, bool light,
                      const weft_grey_fit *start, contest *state)
{
    swap_results(fitter);
    bool is_beaten = !fit_from(fitter, options, light, start, state->least);
    if (!is_beaten)
        hold(fitter, options);
    double own = is_beaten ? INFINITY : weft_texel_weighted_error(fitter);
    bool spoilt = is_beaten || fitter->now.held || own >= BARELY_MORE * fitter->now.residual;
    if (own < state->least)
        state->least = own;
    else
        swap_results(fitter);
    return spoilt;
}

/* The same from the start that leaves least and, where that says so, from another; returns whether it did. */
static bool try_model(weft_texel_fitter *fitter, const weft_fit_options *options, bool light, const weft_frame *given,
                      contest *state)
{
    bool spoilt = try_start(fitter, options, light, &fitter->frames.best, state);
    const weft_grey_fit *other = spoilt ? find_other(fitter, options, given) : NULL;
    if (other)
        try_start(fitter, options, light, other, state);
    return spoilt;
}

/* Whether the grey fit of a smaller model leaves so little that the model needs a look. All its starts are refined: the
 * first alone may leave far more than the model does in the end. */
static bool may_serve(weft_texel_fitter *fitter, const weft_fit_options *whole, const weft_fit_options *options,
                      const weft_frame *given, const contest *state)
{
    bool is_bare = whole->table && !options->table;
    double clear = fitter->light_count > 0 ? CLEARLY_LESS_LIT : is_bare ? CLEARLY_LESS_BARE : CLEARLY_LESS;
    double left = find_start(fitter, options, given)->fit.residual;
    return !(state->is_sure && state->grey < clear * left);
}

/* Without S, without T and with fewer lobes. */
static void try_all_smaller(weft_texel_fitter *fitter, const weft_fit_options *whole, const weft_frame *given,
                            contest *state)
{
    bool light = fitter->light_count > 0;
    weft_fit_options options = *whole;
    for (options.lobe_count = whole->lobe_count; options.lobe_count >= 0; options.lobe_count--) {
        for (int with_table = whole->table; with_table >= 0; with_table--) {
            for (int with_light = light; with_light >= 0; with_light--) {
                bool is_whole =
                    options.lobe_count == whole->lobe_count && with_table == whole->table && with_light == light;
                options.table = with_table;
                if (is_whole)
                    continue;
                double before = state->least;
                if (may_serve(fitter, whole, &options, given, state))
                    try_model(fitter, &options, with_light, given, state);
                state->stepped_down |= state->least < before;
            }
        }
    }
}

/* Fits the whole model, and the smaller ones that may serve better; the best stays. Returns whether that is not the
 * whole one. The diffuse term alone, as it lies beside components, has no smaller model and no other start. */
static bool fit_best(weft_texel_fitter *fitter, const weft_fit_options *whole, const weft_frame *given)
{
    if (whole->lobe_count == 0 && !whole->table && fitter->light_count == 0) {
        fit_model(fitter, whole, false, given);
        return false;
    }
    contest state = {.least = INFINITY, .grey = find_start(fitter, whole, given)->fit.residual};
    bool spoilt = try_model(fitter, whole, fitter->light_count > 0, given, &state);
    state.is_sure = !spoilt && fitter->samples.valid_count > MANY_SAMPLES;
    try_all_smaller(fitter, whole, given, &state);
    return state.stepped_down;
}

/* ---- The model that suffices ---- */

/* The largest model that the samples can carry. */
static weft_fit_options whole_model(const weft_texel_fitter *fitter)
{
    weft_fit_options options = fitter->source->options;
    options.lobe_count =
        weft_fit_affordable_lobes(&fitter->bundle, &fitter->samples, options.lobe_count, options.table);
    return options;
}

static bool meets_target(weft_texel_fitter *fitter)
{
    double target = fitter->source->target_error;
    weft_error_sums sums = weft_texel_measure(fitter, false);
    return sums.square_error <= target * target * sums.square;
}

static void round_codes(const uint8_t *whole, size_t count, int bits, uint8_t *rounded)
{
    for (size_t i = 0; i < count; i++)
        rounded[i] = weft_table_code_rounded(whole[i], bits);
}

/* The fewest bits of T and S with which a model that meets the target still does. */
static void spare_bits(weft_texel_fitter *fitter)
{
    size_t codes = WEFT_CHANNELS * (size_t)fitter->bundle.view_count;
    size_t light_codes = WEFT_CHANNELS * (size_t)fitter->light_count;
    uint8_t *whole = fitter->kept.code, *whole_light = fitter->kept.light_code;
    memcpy(whole, fitter->now.code, codes);
    if (light_codes > 0)
        memcpy(whole_light, fitter->now.light_code, light_codes);
    for (int bits = 4; bits <= 8; bits += 2) {
        round_codes(whole, codes, bits, fitter->now.code);
        round_codes(whole_light, light_codes, bits, fitter->now.light_code);
        if (bits == 8 || (meets_target(fitter) && !weft_texel_is_too_bright(fitter)))
            return;
    }
}

/* Climbs from the smallest model to the whole one, at last with S, until the target is met; returns whether it is. */
static bool fit_smallest(weft_texel_fitter *fitter, const weft_fit_options *whole, const weft_frame *given)
{
    weft_model_ladder ladder = weft_model_ladder_make(whole, fitter->bundle.view_count);
    for (int rung = 0; rung < ladder.count + (fitter->light_count > 0); rung++) {
        bool light = rung == ladder.count;
        weft_texel_model model = ladder.model[light ? rung - 1 : rung];
        weft_fit_options options = *whole;
        options.lobe_count = model.lobe_count;
        options.table = model.table;
        fit_model(fitter, &options, light, given);
        if (meets_target(fitter)) {
            if (model.table || light)
                spare_bits(fitter);
            return true;
        }
    }
    return false;
}

/* Where no model meets the target, the best is as good as any. */
static void fit_to_target(weft_texel_fitter *fitter, const weft_fit_options *whole, const weft_frame *given,
                          weft_texel_counts *counts)
{
    if (fit_smallest(fitter, whole, given))
        return;
    counts->missed++;
    counts->stepped_down += fit_best(fitter, whole, given);
}

/* The frame that a texel is given; NULL where there is none. */
static const weft_frame *find_given(const weft_material *given, int level, int x, int y, weft_frame *frame)
{
    if (!given)
        return NULL;
    const weft_material_level *from = &given->level[level];
    *frame = weft_frame_decode(from->frame + 3 * ((size_t)y * (size_t)from->width + (size_t)x));
    return frame;
}

void weft_texel_fit(weft_texel_fitter *fitter, weft_material *material, int level, int x, int y, const float *sum,
                    const float *count, weft_texel_counts *counts)
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
    counts->texels++;
    counts->empty += fitter->samples.valid_count == 0;
    weft_texel_limit(fitter);
    if (fitter->source->judgement) {
        weft_error_sums judged = weft_texel_judge(fitter, level, x, y);
        weft_error_sums_add(&counts->sums, &judged);
        return;
    }
    weft_frame_search_forget(&fitter->frames);
    weft_fit_options whole = whole_model(fitter);
    fitter->most_lobes = whole.lobe_count;
    weft_frame frame;
    const weft_frame *given = find_given(fitter->source->given, level, x, y, &frame);
    if (fitter->source->target_error > 0)
        fit_to_target(fitter, &whole, given, counts);
    else
        counts->stepped_down += fit_best(fitter, &whole, given);
    weft_error_sums sums = weft_texel_measure(fitter, weft_texel_is_tallied(&material->level[level], x, y));
    weft_error_sums_add(&counts->sums, &sums);
    store_model(fitter, material, level, x, y);
    counts->held += fitter->now.held;
    counts->turned += fitter->now.turns;
    counts->second_start += fitter->now.second_start;
}
