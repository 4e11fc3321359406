#include "compress/compress.h"

#include "btf/dataset_fingerprint.h"
#include "btf/json_text.h"
#include "btf/material_models.h"
#include "btf/processor.h"
#include "compress/budget.h"
#include "compress/given_frames.h"
#include "compress/memory.h"
#include "compress/opacity.h"
#include "compress/sparse_material.h"
#include "compress/table_pca.h"

#include <inttypes.h>
#include <malloc.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <zlib.h>

enum {
    SAMPLES_PER_PARAMETER = 4,
    METADATA_BYTES = 2048 /* besides the provenance */
};

static const char *const model_name[3] = {"lobes and view table", "lobes", "sparse"};

weft_compress_options weft_compress_default_options(void)
{
    return (weft_compress_options){
        .lobe_count = 2, .table = true, .levels = true, .frames = WEFT_FRAMES_FITTED, .max_exponent = 8192};
}

static int used_images(const weft_dataset_layout *layout, const uint8_t *held_out)
{
    int count = 0;
    for (int image = 0; image < layout->image_count; image++)
        count += !(held_out && held_out[image]);
    return count;
}

static weft_code check_options(const weft_dataset *dataset, const weft_compress_options *options, weft_error *error)
{
    if (options->lobe_count < 0 || options->lobe_count > WEFT_MATERIAL_MAX_LOBES)
        return weft_fail(error, WEFT_BAD_USAGE, "%d lobes asked for, must be 0 to %d", options->lobe_count,
                         WEFT_MATERIAL_MAX_LOBES);
    if (!(options->max_exponent >= 1 && options->max_exponent <= 60000))
        return weft_fail(error, WEFT_BAD_USAGE, "largest exponent is %g, must be 1 to 60000", options->max_exponent);
    if (!(options->target_error >= 0 && options->target_error <= 1))
        return weft_fail(error, WEFT_BAD_USAGE, "target error is %g, must be 0 to 1", options->target_error);
    if (options->table_components < 0 || options->table_components > WEFT_BASIS_MAX_COMPONENTS)
        return weft_fail(error, WEFT_BAD_USAGE, "%d components of tables asked for, must be 1 to %d",
                         options->table_components, WEFT_BASIS_MAX_COMPONENTS);
    if (options->table_components > 0 && (options->target_error > 0 || options->budget_bytes > 0))
        return weft_fail(error, WEFT_BAD_USAGE,
                         "components of tables are shared by all texels: no target error or budget for each of them");
    if (options->target_error > 0 && options->budget_bytes > 0)
        return weft_fail(error, WEFT_BAD_USAGE, "a target error and a budget exclude each other");
    if (used_images(weft_dataset_get_layout(dataset), options->held_out) == 0)
        return weft_fail(error, WEFT_BAD_USAGE, "'%s': every image is held out", weft_dataset_path(dataset));
    return WEFT_OK;
}

/* What so many samples a texel can carry. T belongs to fixed directions, so that near cameras have none. */
static void plan(const weft_dataset_layout *layout, const weft_compress_options *options, weft_compress_report *report)
{
    int images = used_images(layout, options->held_out);
    int lobes = 1 + 4 * options->lobe_count;
    bool table = options->table && layout->distance == WEFT_FAR && layout->view_count <= WEFT_MATERIAL_MAX_VIEWS;
    report->lobe_count = options->lobe_count;
    report->model = WEFT_COMPRESS_SPARSE;
    if (table && images >= SAMPLES_PER_PARAMETER * (lobes + layout->view_count)) {
        report->model = WEFT_COMPRESS_TABLE;
    } else if (images >= SAMPLES_PER_PARAMETER * lobes) {
        report->model = WEFT_COMPRESS_LOBES;
    } else if (images >= SAMPLES_PER_PARAMETER * (1 + 4)) {
        report->model = WEFT_COMPRESS_LOBES;
        report->lobe_count = (images / SAMPLES_PER_PARAMETER - 1) / 4;
    } else if (options->lobe_count > 1) {
        report->lobe_count = 1;
    }
}

/* The directions of S: those that the bundle of the fit labels. */
static weft_code find_lights(const weft_dataset_layout *layout, const weft_compress_options *options,
                             const weft_compress_report *report, weft_bundle *bundle, weft_error *error)
{
    *bundle = (weft_bundle){0};
    if (!options->light_table || report->model == WEFT_COMPRESS_SPARSE)
        return WEFT_OK;
    WEFT_TRY(weft_bundle_create(layout, options->held_out, bundle, error));
    int parameters = 1 + 4 * report->lobe_count + bundle->light_count +
                     (report->model == WEFT_COMPRESS_TABLE ? layout->view_count : 0);
    if (bundle->image_count < SAMPLES_PER_PARAMETER * parameters || bundle->light_count > WEFT_MATERIAL_MAX_VIEWS)
        bundle->light_count = 0;
    return WEFT_OK;
}

static weft_code create_material(const weft_dataset_layout *layout, const weft_compress_options *options,
                                 const weft_compress_report *report, weft_material *material, weft_error *error)
{
    int views = report->model == WEFT_COMPRESS_TABLE ? layout->view_count : 0;
    weft_bundle bundle;
    WEFT_TRY(find_lights(layout, options, report, &bundle, error));
    weft_code code = weft_material_create(layout->width, layout->height, report->lobe_count, views, bundle.light_count,
                                          options->levels, material, error);
    if (code == WEFT_OK) {
        material->texel_pitch_mm = layout->texel_pitch_mm;
        for (int view = 0; view < views; view++)
            material->view[view] = weft_unit(layout->view[view]);
        for (int light = 0; light < bundle.light_count; light++)
            material->light[light] = weft_unit(bundle.distinct[light]);
    }
    weft_bundle_free(&bundle);
    return code;
}

/* ---- Metadata ---- */

static json_t *describe_fit(const weft_compress_options *options, const weft_compress_report *report,
                            const weft_sparse_setting *setting)
{
    double texels = (double)(report->texel_count > 0 ? report->texel_count : 1);
    json_t *fit = json_pack(
        "{s:s, s:i, s:f, s:I, s:I, s:I, s:I, s:f, s:f}", "model", model_name[report->model], "lobes",
        report->lobe_count, "largest_exponent", options->max_exponent, "samples", (json_int_t)report->sample_count,
        "masked_samples", (json_int_t)report->masked_count, "texels", (json_int_t)report->texel_count, "empty_texels",
        (json_int_t)report->empty_texel_count, "turned_frames", (double)report->turned_frame_count / texels,
        "retro_reflective_starts", (double)report->second_start_count / texels);
    if (options->weights == WEFT_WEIGHTS_SCREEN && report->model != WEFT_COMPRESS_SPARSE)
        weft_json_put(&fit, "weights", json_string("screen"));
    if (options->target_error > 0) {
        weft_json_put(&fit, "target_error", json_real(options->target_error));
        weft_json_put(&fit, "texels_above_target", json_integer((json_int_t)report->missed_texel_count));
    }
    if (options->budget_bytes > 0)
        weft_json_put(&fit, "budget_bytes", json_integer((json_int_t)options->budget_bytes));
    if (report->table_components > 0)
        weft_json_put(&fit, "table_components", json_integer(report->table_components));
    if (report->model == WEFT_COMPRESS_SPARSE) {
        weft_json_put(&fit, "largest_exponent", json_real(setting->largest_exponent));
        weft_json_put(&fit, "fitted_normals", json_boolean(setting->stiffness < 1e300));
    }
    return fit;
}

/* {"provenance": of the dataset, "dataset": its fingerprint, "fit": what was done}. No time of day and no duration, so
 * that equal input gives equal bytes. */
static weft_code write_metadata(const weft_dataset_layout *layout, const weft_dataset_fingerprint *fingerprint,
                                json_t *fit, weft_material *material, weft_error *error)
{
    char layout_text[WEFT_CHECKSUM_TEXT], samples_text[WEFT_CHECKSUM_TEXT];
    weft_checksum_print(fingerprint->layout, layout_text);
    weft_checksum_print(fingerprint->samples, samples_text);
    json_t *provenance = json_loads(layout->provenance, 0, NULL);
    json_t *object = json_pack("{s:o, s:{s:s, s:s}, s:o}", "provenance", provenance, "dataset", "layout", layout_text,
                               "samples", samples_text, "fit", fit);
    char *text = object ? json_dumps(object, JSON_COMPACT | JSON_SORT_KEYS) : NULL;
    json_decref(object);
    if (!text)
        return weft_fail_memory(error, "metadata of the material", 0);
    free(material->metadata);
    material->metadata = text;
    return WEFT_OK;
}

/* ---- Checkpoints ---- */

typedef struct identity_text {
    char program[96], dataset[192], options[256];
} identity_text;

/* Whose work a checkpoint keeps. Instruction sets round differently. */
static weft_code identify(const weft_dataset *dataset, const weft_compress_options *options,
                          const weft_compress_report *report, const weft_dataset_fingerprint *fingerprint,
                          identity_text *text, weft_error *error)
{
    struct stat status;
    const char *path = weft_dataset_path(dataset);
    if (stat(path, &status) != 0)
        return weft_fail_errno(error, "look at", path);
    uLong held_out = 0;
    if (options->held_out)
        held_out = crc32_z(0, options->held_out, (size_t)weft_dataset_get_layout(dataset)->image_count);
    snprintf(text->program, sizeof text->program, "weft %s, %s", WEFT_VERSION,
             weft_instruction_set_name(weft_processor_instruction_set()));
    snprintf(text->dataset, sizeof text->dataset,
             "layout %08" PRIx32 ", samples %08" PRIx32 ", %lld bytes of %lld.%09ld", fingerprint->layout,
             fingerprint->samples, (long long)status.st_size, (long long)status.st_mtim.tv_sec,
             (long)status.st_mtim.tv_nsec);
    snprintf(text->options, sizeof text->options,
             "%s, %d lobes, lights %d, weights %d, frames %d, N <= %.17g, error <= %.17g, levels %d, held out %08lx",
             model_name[report->model], report->lobe_count, options->light_table, (int)options->weights,
             (int)options->frames, options->max_exponent, options->target_error, options->levels, held_out);
    return WEFT_OK;
}

/* ---- The whole ---- */

/* What a fit hands from step to step. */
typedef struct fitting {
    weft_dataset *dataset;
    const weft_compress_options *options;
    const weft_progress *progress;
    weft_memory_budget budget;
    weft_dataset_fingerprint fingerprint;
    weft_sparse_setting setting;
    weft_texel_counts counts;
} fitting;

/* Of the metadata, at most: its numbers may be longer than those of the provenance that they come from. */
static weft_code metadata_bytes(const weft_dataset_layout *layout, uint64_t *bytes, weft_error *error)
{
    json_t *provenance = json_loads(layout->provenance, 0, NULL);
    size_t size = provenance ? json_dumpb(provenance, NULL, 0, JSON_COMPACT) : 0;
    json_decref(provenance);
    if (size == 0)
        return weft_fail_memory(error, "provenance", strlen(layout->provenance));
    *bytes = METADATA_BYTES + size;
    return WEFT_OK;
}

/* With a target or a budget: which model each texel has is part of the material. */
static weft_code fit_chosen(fitting *of, const weft_texel_source *source, const weft_dense_job *job,
                            weft_material *material, weft_dense_result *result, weft_error *error)
{
    weft_budget_plan plan = {.bytes = of->options->budget_bytes};
    WEFT_TRY(metadata_bytes(source->layout, &plan.reserve, error));
    if (plan.bytes > 0)
        return weft_budget_fit(of->dataset, source, job, &plan, material, result, error);
    WEFT_TRY(weft_dense_fit(of->dataset, source, job, material, result, error));
    return source->target_error > 0 ? weft_material_find_models(material, error) : WEFT_OK;
}

/* Tables by components, and the lobes fitted to them in a second pass over the samples. That needs no checkpoint: what
 * it starts from is the first pass, which has one. */
static weft_code reduce_tables(fitting *of, const weft_texel_source *source, const weft_dense_job *job,
                               weft_material *material, weft_dense_result *result, weft_error *error)
{
    weft_texel_source again = *source;
    weft_dense_job alone = *job;
    weft_dense_result second;
    WEFT_TRY(
        weft_material_reduce_tables(source->layout, source->held_out, material, of->options->table_components, error));
    again.tables = material;
    alone.checkpoint_path = NULL;
    WEFT_TRY(weft_dense_fit(of->dataset, &again, &alone, material, &second, error));
    result->times.bytes += second.times.bytes;
    result->times.reading += second.times.reading;
    result->times.starving += second.times.starving;
    return WEFT_OK;
}

static weft_code fit_dense(fitting *of, weft_material *material, weft_compress_report *report, weft_error *error)
{
    const weft_compress_options *options = of->options;
    identity_text identity;
    weft_dense_result result;
    WEFT_TRY(weft_given_frames_store(of->dataset, material, error));
    WEFT_TRY(identify(of->dataset, options, report, &of->fingerprint, &identity, error));
    weft_dense_job job = {.budget = of->budget,
                          .checkpoint_path = options->checkpoint_path,
                          .identity = {identity.program, identity.dataset, identity.options},
                          .note = options->note,
                          .progress = of->progress};
    weft_texel_source source = {.layout = weft_dataset_get_layout(of->dataset),
                                .held_out = options->held_out,
                                .options = weft_fit_default_options(),
                                .light_table = material->light_count > 0,
                                .weights = options->weights,
                                .frames = options->frames,
                                .target_error = options->target_error};
    if (options->frames == WEFT_FRAMES_GIVEN ||
        (options->frames == WEFT_FRAMES_FITTED && weft_dataset_has_frames(of->dataset)))
        source.given = material;
    source.options.lobe_count = report->lobe_count;
    source.options.table = report->model == WEFT_COMPRESS_TABLE;
    source.options.max_exponent = options->max_exponent;
    WEFT_TRY(fit_chosen(of, &source, &job, material, &result, error));
    if (options->table_components > 0 && material->view_count + material->light_count > 0) {
        WEFT_TRY(reduce_tables(of, &source, &job, material, &result, error));
        report->table_components = options->table_components;
    }
    /* What is free is given back to the system, so that writing the material has room. */
    malloc_trim(0);
    of->counts = result.counts;
    report->light_count = material->light_count;
    report->masked_count = result.masked;
    report->block_count = (long)result.block_count;
    report->resumed_block_count = (long)result.resumed_block_count;
    report->read_bytes = (double)result.times.bytes;
    report->read_seconds = result.times.reading;
    report->starved_seconds = result.times.starving;
    return WEFT_OK;
}

/* Fields, their halves and the search of compress/sparse_search.h, from above. */
static uint64_t sparse_bytes(const weft_dataset_layout *layout)
{
    uint64_t texels = (uint64_t)layout->width * (uint64_t)layout->height, threads = (uint64_t)omp_get_max_threads();
    return texels * (64 * (uint64_t)layout->image_count + 128 * threads + 256);
}

static weft_code fit_sparse(fitting *of, weft_material *material, weft_compress_report *report, weft_error *error)
{
    if (of->options->target_error > 0 || of->options->budget_bytes > 0)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "'%s' has too few images to choose a model for each texel: leave out the target or the budget",
                         weft_dataset_path(of->dataset));
    uint64_t bytes = weft_memory_budget_taken(&of->budget) + sparse_bytes(weft_dataset_get_layout(of->dataset));
    if (bytes > of->budget.limit)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "'%s' has so few images that all samples are fitted together: that needs %llu MB of memory, "
                         "more than the limit of %llu MB",
                         weft_dataset_path(of->dataset), (unsigned long long)(bytes / 1000000 + 1),
                         (unsigned long long)(of->budget.limit / 1000000));
    return weft_sparse_material_fit(of->dataset, of->options->held_out, of->progress, material, &of->setting,
                                    &of->counts, &report->masked_count, error);
}

static weft_code fit_material(fitting *of, weft_material *material, weft_compress_report *report, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(of->dataset);
    WEFT_TRY(weft_dataset_fingerprint_take(of->dataset, &of->fingerprint, error));
    WEFT_TRY(opacity_fill(of->dataset, material, error));
    if (report->model == WEFT_COMPRESS_SPARSE)
        WEFT_TRY(fit_sparse(of, material, report, error));
    else
        WEFT_TRY(fit_dense(of, material, report, error));
    if (of->counts.empty == of->counts.texels && !of->options->held_out)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' holds no valid sample", weft_dataset_path(of->dataset));
    report->texel_count = of->counts.texels;
    report->empty_texel_count = of->counts.empty;
    report->turned_frame_count = of->counts.turned;
    report->second_start_count = of->counts.second_start;
    report->missed_texel_count = of->counts.missed;
    report->sample_count = (long)layout->width * layout->height * used_images(layout, of->options->held_out);
    return write_metadata(layout, &of->fingerprint, describe_fit(of->options, report, &of->setting), material, error);
}

static double seconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

weft_code weft_compress(weft_dataset *dataset, const weft_compress_options *options, const weft_progress *progress,
                        weft_material *material, weft_compress_report *report, weft_error *error)
{
    weft_compress_report own = {0};
    double began = seconds_now();
    WEFT_TRY(check_options(dataset, options, error));
    plan(weft_dataset_get_layout(dataset), options, &own);
    fitting of = {.dataset = dataset,
                  .options = options,
                  .progress = progress,
                  .budget = weft_memory_budget_begin(options->memory_bytes)};
    WEFT_TRY(create_material(weft_dataset_get_layout(dataset), options, &own, material, error));
    weft_code code = fit_material(&of, material, &own, error);
    if (code != WEFT_OK)
        weft_material_free(material);
    own.seconds = seconds_now() - began;
    if (report)
        *report = own;
    return code;
}
