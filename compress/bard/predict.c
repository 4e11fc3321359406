#include "compress/bard/predict.h"

#include "base/integers.h"
#include "btf/dataset/write_blocks.h"
#include "btf/direction/direction.h"
#include "compress/bard/texel_table.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

/* More samples than these do not change a median that is printed with three digits. */
static const long enough_samples = 2000000;

weft_bard_options weft_bard_defaults(void)
{
    return (weft_bard_options){.map = WEFT_BARD_IN_PLANE, .diffuse_share = 1};
}

/* What the pass over the blocks carries along. */
typedef struct predicting {
    weft_dataset *dataset;
    const weft_dataset_layout *layout;
    const weft_bard_options *options;
    weft_bard_plan plan;
    weft_bard_report *report;
    int block_width, block_height;
    weft_half *measured, *predicted; /* [block_height][block_width][image_count][3] */
    uint8_t *measured_mask, *mask;   /* [block_height][block_width][image_count] */
    int thread_count;
    weft_bard_texel *texel; /* [thread_count] */
    long stride;            /* the error is measured in every stride-th texel */
    weft_compared *value;
    uint8_t *light_ring; /* [value_count] of ubo81 */
    size_t value_count;
} predicting;

/* The texels of the dataset that are in memory. */
typedef struct texel_block {
    int x, y, width, height;
} texel_block;

/* ---- A block ---- */

static void predict_texel(const predicting *pass, weft_bard_texel *texel, size_t at)
{
    size_t images = (size_t)pass->layout->image_count;
    weft_bard_texel_measure(&pass->plan, pass->layout, pass->options->diffuse_share, pass->measured + 3 * at * images,
                            pass->measured_mask + at * images, texel);
    weft_bard_texel_predict(&pass->plan, pass->layout, texel, pass->predicted + 3 * at * images,
                            pass->mask + at * images);
}

static void predict_block(predicting *pass, texel_block block)
{
    long texels = (long)block.width * block.height, filled = 0, empty = 0;
#pragma omp parallel for reduction(+ : filled, empty) num_threads(pass->thread_count)
    for (long at = 0; at < texels; at++) {
        weft_bard_texel *texel = &pass->texel[omp_get_thread_num()];
        predict_texel(pass, texel, (size_t)at);
        empty += texel->filled_count < 0;
        filled += texel->filled_count > 0 ? texel->filled_count : 0;
    }
    pass->report->filled_count += filled;
    pass->report->empty_texel_count += empty;
}

/* The predicted images of one texel against what was photographed. */
static void compare_texel(predicting *pass, size_t at)
{
    const weft_dataset_layout *layout = pass->layout;
    for (int i = 0; i < layout->image_count; i++) {
        size_t sample = at * (size_t)layout->image_count + (size_t)i;
        if (pass->plan.is_used[i] || pass->measured_mask[sample] || pass->mask[sample] || !(pass->plan.mix[i].gain > 0))
            continue;
        uint8_t light_ring = (uint8_t)weft_ubo81_ring(weft_angles_of_direction(layout->light[i]).theta_rad);
        for (size_t c = 0; c < 3; c++) {
            pass->light_ring[pass->value_count] = light_ring;
            pass->value[pass->value_count++] =
                (weft_compared){.sample = weft_float_of_half(pass->measured[3 * sample + c]),
                                .prediction = weft_float_of_half(pass->predicted[3 * sample + c])};
        }
    }
}

static void compare_block(predicting *pass, texel_block block)
{
    for (int y = 0; y < block.height; y++) {
        for (int x = 0; x < block.width; x++) {
            long number = (long)(block.y + y) * pass->layout->width + block.x + x;
            if (number % pass->stride == 0)
                compare_texel(pass, (size_t)y * (size_t)block.width + (size_t)x);
        }
    }
}

static weft_code pass_block(predicting *pass, texel_block block, weft_dataset_block_writer *writer, weft_error *error)
{
    WEFT_TRY(weft_dataset_read_block(pass->dataset, block.x, block.y, block.width, block.height, pass->measured,
                                     pass->measured_mask, error));
    predict_block(pass, block);
    compare_block(pass, block);
    return weft_dataset_block_writer_put(writer, block.x, block.y, block.width, block.height, pass->predicted,
                                         pass->mask, error);
}

/* ---- All blocks ---- */

static weft_code pass_blocks(predicting *pass, weft_dataset_block_writer *writer, const weft_progress *progress,
                             weft_error *error)
{
    const weft_dataset_layout *layout = pass->layout;
    weft_progress_report(progress, "predicting images", 0, layout->height);
    for (int y = 0; y < layout->height; y += pass->block_height) {
        int height = weft_smaller(pass->block_height, layout->height - y);
        for (int x = 0; x < layout->width; x += pass->block_width) {
            texel_block block = {x, y, weft_smaller(pass->block_width, layout->width - x), height};
            WEFT_TRY(pass_block(pass, block, writer, error));
        }
        weft_progress_report(progress, "predicting images", y + height, layout->height);
    }
    return WEFT_OK;
}

/* Whether any texel has a hole. */
static weft_code find_holes(weft_dataset *dataset, float *row, bool *is_any, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    size_t count = (size_t)layout->width * (size_t)layout->view_count;
    *is_any = false;
    for (int y = 0; y < layout->height && !*is_any; y++) {
        WEFT_TRY(weft_dataset_read_opacity(dataset, y, 1, row, error));
        for (size_t i = 0; i < count; i++)
            *is_any |= row[i] < 1;
    }
    return WEFT_OK;
}

static weft_code copy_opacity(weft_dataset *dataset, weft_dataset_block_writer *writer, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    size_t row = (size_t)layout->width * (size_t)layout->view_count, all = row * (size_t)layout->height;
    bool is_any;
    float *opacity = malloc(row * sizeof *opacity);
    if (!opacity)
        return weft_fail_memory(error, "opacity", row * sizeof *opacity);
    weft_code code = find_holes(dataset, opacity, &is_any, error);
    free(opacity);
    if (code != WEFT_OK || !is_any)
        return code;
    opacity = malloc(all * sizeof *opacity);
    if (!opacity)
        return weft_fail_memory(error, "opacity", all * sizeof *opacity);
    code = weft_dataset_read_opacity(dataset, 0, layout->height, opacity, error);
    if (code == WEFT_OK)
        code = weft_dataset_block_writer_put_opacity(writer, opacity, error);
    free(opacity);
    return code;
}

/* What the provenance of a prediction has. */
static const char provenance_name[] = "prediction";

static weft_code finish(const predicting *pass, weft_dataset_block_writer *writer, weft_error *error)
{
    const weft_bard_report *report = pass->report;
    json_t *made = json_pack("{ss ss sf sf si si}", "model", "BARD", "map",
                             pass->options->map == WEFT_BARD_PRINTED ? "printed" : "in plane", "diffuse_share",
                             pass->options->diffuse_share, "largest_tilt_deg", report->largest_tilt_deg,
                             "photographs_used", report->photograph_count, "images", report->image_count);
    return weft_derived_dataset_finish(writer, pass->layout, provenance_name, made, error);
}

static weft_code write_predictions(predicting *pass, const char *output, const weft_progress *progress,
                                   weft_error *error)
{
    weft_dataset_block_writer *writer;
    WEFT_TRY(weft_dataset_block_writer_create(output, pass->layout, &writer, error));
    weft_code code = pass_blocks(pass, writer, progress, error);
    if (code == WEFT_OK)
        code = copy_opacity(pass->dataset, writer, error);
    if (code == WEFT_OK)
        return finish(pass, writer, error);
    weft_dataset_block_writer_abandon(writer);
    return code;
}

/* ---- The whole ---- */

static weft_code allocate_texels(predicting *pass, weft_error *error)
{
    pass->texel = calloc((size_t)omp_get_max_threads(), sizeof *pass->texel);
    if (!pass->texel)
        return weft_fail_memory(error, "tables", (size_t)omp_get_max_threads() * sizeof *pass->texel);
    pass->thread_count = omp_get_max_threads();
    for (int i = 0; i < pass->thread_count; i++)
        WEFT_TRY(weft_bard_texel_create(&pass->plan, &pass->texel[i], error));
    return WEFT_OK;
}

static weft_code allocate(predicting *pass, weft_error *error)
{
    const weft_dataset_layout *layout = pass->layout;
    weft_dataset_block_size(layout, &pass->block_width, &pass->block_height);
    size_t images = (size_t)layout->image_count;
    size_t block = (size_t)pass->block_width * (size_t)pass->block_height * images;
    long texels = (long)layout->width * layout->height;
    /* An odd stride that no common width divides spreads the chosen texels over all columns. */
    pass->stride = (texels * layout->image_count + enough_samples - 1) / enough_samples | 1;
    size_t values = 3 * images * (size_t)((texels + pass->stride - 1) / pass->stride);
    pass->measured = malloc(3 * block * sizeof *pass->measured);
    pass->predicted = malloc(3 * block * sizeof *pass->predicted);
    pass->measured_mask = malloc(block);
    pass->mask = malloc(block);
    pass->value = malloc(values * sizeof *pass->value);
    pass->light_ring = malloc(values);
    if (!pass->measured || !pass->predicted || !pass->measured_mask || !pass->mask || !pass->value || !pass->light_ring)
        return weft_fail_memory(error, "block of texels", 14 * block + values * (sizeof *pass->value + 1));
    return allocate_texels(pass, error);
}

static void free_pass(predicting *pass)
{
    for (int i = 0; i < pass->thread_count; i++)
        weft_bard_texel_free(&pass->texel[i]);
    free(pass->texel);
    free(pass->measured);
    free(pass->predicted);
    free(pass->measured_mask);
    free(pass->mask);
    free(pass->value);
    free(pass->light_ring);
    weft_bard_plan_free(&pass->plan);
}

static weft_code summarise(const predicting *pass, weft_error *error)
{
    weft_bard_report *report = pass->report;
    WEFT_TRY(weft_error_summary_of(pass->value, pass->value_count, &report->all, error));
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++)
        WEFT_TRY(weft_error_summary_of_group(pass->value, pass->light_ring, pass->value_count, ring,
                                             &report->by_light[ring], error));
    return WEFT_OK;
}

weft_code weft_bard_predict(weft_dataset *dataset, const char *output, const weft_bard_options *options,
                            const weft_progress *progress, weft_bard_report *report, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    predicting pass = {.dataset = dataset, .layout = layout, .options = options, .report = report};
    *report = (weft_bard_report){.image_count = layout->image_count};
    WEFT_TRY(weft_derived_dataset_check(dataset, output, "predictions would replace its photographs", error));
    WEFT_TRY(weft_bard_plan_create(layout, NULL, weft_dataset_path(dataset), options->map, &pass.plan, error));
    report->photograph_count = pass.plan.count;
    report->largest_tilt_deg = pass.plan.largest_tilt_deg;
    weft_code code = allocate(&pass, error);
    if (code == WEFT_OK)
        code = write_predictions(&pass, output, progress, error);
    if (code == WEFT_OK)
        code = summarise(&pass, error);
    free_pass(&pass);
    return code;
}

weft_code weft_bard_check(const char *path, weft_error *error)
{
    weft_dataset *dataset;
    WEFT_TRY(weft_dataset_open(path, &dataset, error));
    /* The dataset was opened, so its provenance is JSON. */
    json_t *provenance = json_loads(weft_dataset_get_layout(dataset)->provenance, 0, NULL);
    bool is_short = !provenance, is_predicted = json_object_get(provenance, provenance_name) != NULL;
    json_decref(provenance);
    weft_dataset_close(dataset);
    if (is_short)
        return weft_fail_memory(error, "provenance", 0);
    return is_predicted
               ? WEFT_OK
               : weft_fail(error, WEFT_BAD_INPUT, "'%s' is no prediction: `weft bard` makes one of a dataset", path);
}

/* ---- Texels in memory ---- */

int weft_bard_count_photographs(const weft_dataset_layout *layout, const uint8_t *left_out)
{
    weft_bard_plan plan;
    if (weft_bard_plan_create(layout, left_out, "", WEFT_BARD_IN_PLANE, &plan, NULL) != WEFT_OK)
        return 0;
    int count = plan.count;
    weft_bard_plan_free(&plan);
    return count;
}

static void predict_unknown(size_t values, weft_half *predicted)
{
    for (size_t i = 0; i < values; i++)
        predicted[i] = weft_half_of_float(NAN);
}

static weft_code predict_texels(const weft_bard_plan *plan, const weft_dataset_layout *layout, double diffuse_share,
                                const weft_half *samples, const uint8_t *mask, long texel_count, weft_half *predicted,
                                weft_error *error)
{
    size_t images = (size_t)layout->image_count;
    weft_bard_texel texel = {0};
    uint8_t *ignored = malloc(images);
    weft_code code = ignored ? weft_bard_texel_create(plan, &texel, error) : weft_fail_memory(error, "images", images);
    for (size_t at = 0; at < (size_t)texel_count && code == WEFT_OK; at++) {
        weft_bard_texel_measure(plan, layout, diffuse_share, samples + 3 * at * images, mask + at * images, &texel);
        weft_bard_texel_predict(plan, layout, &texel, predicted + 3 * at * images, ignored);
        if (texel.filled_count < 0)
            predict_unknown(3 * images, predicted + 3 * at * images);
    }
    weft_bard_texel_free(&texel);
    free(ignored);
    return code;
}

weft_code weft_bard_predict_texels(const weft_dataset_layout *layout, const uint8_t *left_out,
                                   const weft_bard_options *options, const weft_half *samples, const uint8_t *mask,
                                   long texel_count, weft_half *predicted, weft_error *error)
{
    weft_bard_plan plan;
    WEFT_TRY(weft_bard_plan_create(layout, left_out, "the dataset", options->map, &plan, error));
    weft_code code =
        predict_texels(&plan, layout, options->diffuse_share, samples, mask, texel_count, predicted, error);
    weft_bard_plan_free(&plan);
    return code;
}
