#include "compare/tradeoff/prediction.h"

#include "base/integers.h"
#include "base/text/json_text.h"
#include "btf/material/held_out.h"
#include "btf/material/metadata.h"
#include "compare/tradeoff/weight.h"
#include "compress/compress.h"
#include "compress/hold_out/texel_subset.h"
#include "compress/run/memory.h"

#include <stdlib.h>
#include <string.h>

enum { SIDE = 64, LEAST_SIDE = 32, SQUARE_SIDE = 16 /* of WEFT_TEXEL_SUBSET_PATCHES */ };

static const long most_samples_of_squares = 1L << 25, most_samples_of_block = 1L << 19;

/* One prediction at work. */
typedef struct predicting {
    weft_dataset *dataset;
    const weft_compress_options *options;
    const char *scratch_path;
    weft_frame_timer *timer;
    weft_prediction *prediction;
} predicting;

/* ---- What the file will say ---- */

static weft_code complete_metadata(const predicting *work, weft_material *material, weft_error *error)
{
    weft_hold_out expected;
    const char *provenance = weft_dataset_get_layout(work->dataset)->provenance;
    WEFT_TRY(weft_expected_record(work->dataset, work->options, &expected, error));
    WEFT_TRY(weft_material_put_metadata(material, "provenance", json_loads(provenance, 0, NULL), error));
    WEFT_TRY(weft_hold_out_store(&expected, material, error));
    return weft_material_put_metadata(material, "predicted", weft_prediction_to_json(work->prediction), error);
}

/* ---- Some texels ---- */

/* The weight of a material of some texels, and then how long its frame takes, both as of the whole. */
static weft_code measure_costs(const predicting *work, weft_material *material, weft_weight *weight, weft_error *error)
{
    weft_weight with_heights;
    weft_error ignored;
    bool must = work->prediction->least_fps > 0;
    WEFT_TRY(complete_metadata(work, material, error));
    WEFT_TRY(weft_weight_of(material, weight, error));
    if (work->options->heights)
        WEFT_TRY(weft_compress_take_heights(work->dataset, material, error));
    WEFT_TRY(weft_weight_of(material, &with_heights, error));
    weight->shared = with_heights.shared + with_heights.by_texels - weight->by_texels;
    if (!work->timer)
        return WEFT_OK;
    work->prediction->frame_ms = 0;
    weft_code code =
        weft_frame_timer_of_material(work->timer, material, &work->prediction->frame_ms, must ? error : &ignored);
    return must ? code : WEFT_OK;
}

static weft_code fit(const predicting *work, weft_dataset *some, weft_weight *weight, weft_error *error)
{
    weft_compress_options options = *work->options;
    weft_material material;
    options.heights = false; /* those of the whole are given afterwards */
    WEFT_TRY(weft_compress(some, &options, NULL, &material, NULL, error));
    weft_code code = measure_costs(work, &material, weight, error);
    weft_material_free(&material);
    return code;
}

/* Frees the subset before the fit. */
static weft_code fit_subset(const predicting *work, weft_texel_subset *subset, weft_weight *weight, weft_error *error)
{
    weft_dataset *some = NULL;
    uint8_t *none = calloc((size_t)subset->layout.image_count, 1);
    weft_code code = none ? weft_texel_subset_write(subset, none, work->scratch_path, &some, error)
                          : weft_fail_memory(error, "images", (size_t)subset->layout.image_count);
    free(none);
    weft_texel_subset_free(subset);
    if (code == WEFT_OK)
        code = fit(work, some, weight, error);
    weft_dataset_close(some);
    return code;
}

/* Near images have places, so that their texels stay where they are; there are few, and fits of a handful share what
 * they find: then the block is larger. */
static int side_of_block(int image_count)
{
    int side = LEAST_SIDE;
    while ((long)(side + 1) * (side + 1) * image_count <= most_samples_of_block)
        side++;
    return side;
}

static int side_of_squares(int image_count)
{
    int side = SIDE;
    while (side > SQUARE_SIDE && (long)side * side * image_count > most_samples_of_squares)
        side -= SQUARE_SIDE;
    return side;
}

/* That the samples are within the memory that is allowed, once as they are read and once as they are written. */
static weft_code require_memory(const predicting *work, int side, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    uint64_t width = (uint64_t)weft_smaller(side, layout->width), height = (uint64_t)weft_smaller(side, layout->height);
    weft_memory_budget budget = weft_memory_budget_begin(work->options->memory_bytes);
    return weft_memory_budget_require(
        &budget, 2 * (3 * sizeof(weft_half) + 1) * width * height * (uint64_t)layout->image_count,
        weft_dataset_path(work->dataset), "the texels by which its size is predicted", error);
}

static weft_code read_subset(const predicting *work, weft_texel_subset *subset, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    bool is_near = layout->distance == WEFT_NEAR;
    int side = is_near ? side_of_block(layout->image_count) : side_of_squares(layout->image_count);
    WEFT_TRY(require_memory(work, side, error));
    return weft_texel_subset_read(work->dataset, is_near ? WEFT_TEXEL_SUBSET_BLOCK : WEFT_TEXEL_SUBSET_PATCHES, side,
                                  subset, error);
}

weft_code weft_prediction_find_costs(weft_dataset *dataset, const weft_compress_options *options,
                                     const char *scratch_path, weft_frame_timer *timer, weft_prediction *prediction,
                                     weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    const predicting work = {dataset, options, scratch_path, timer, prediction};
    weft_weight weight;
    weft_texel_subset subset;
    WEFT_TRY(read_subset(&work, &subset, error));
    WEFT_TRY(fit_subset(&work, &subset, &weight, error));
    prediction->bytes = weft_weight_scaled(&weight, layout->width, layout->height, options->levels);
    return WEFT_OK;
}

/* ---- JSON ---- */

/* The time of a frame is not the same twice: it is there only where it was asked for, and equal files are equal. */
json_t *weft_prediction_to_json(const weft_prediction *p)
{
    json_t *object = json_pack("{s:s, s:s, s:f, s:f}", "model", p->model, "options", p->arguments, "bytes", p->bytes,
                               "relative_rmse", p->error);
    if (p->preset != WEFT_PRESET_NONE)
        weft_json_put(&object, "preset", json_string(weft_preset_name(p->preset)));
    if (p->least_fps > 0) {
        weft_json_put(&object, "least_fps", json_real(p->least_fps));
        weft_json_put(&object, "frame_ms", json_real(p->frame_ms));
    }
    return object;
}

json_t *weft_prediction_to_event(const weft_prediction *prediction)
{
    json_t *object = weft_prediction_to_json(prediction);
    if (prediction->frame_ms > 0)
        weft_json_put(&object, "frame_ms", json_real(prediction->frame_ms));
    return object;
}
