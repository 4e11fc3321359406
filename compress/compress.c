#include "compress/compress.h"

#include "base/clock.h"
#include "base/processor.h"
#include "btf/dataset/fingerprint.h"
#include "btf/material/models.h"
#include "compress/components/components_fit.h"
#include "compress/metadata.h"
#include "compress/run/budget.h"
#include "compress/run/given_frames.h"
#include "compress/run/memory.h"
#include "compress/run/opacity.h"
#include "compress/sparse/sparse_material.h"

#include <inttypes.h>
#include <malloc.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <zlib.h>

/* Of fewer near images the sparse model, whose texels see highlights for each other, predicts more than components do.
 */
enum { SAMPLES_PER_PARAMETER = 4, LEAST_NEAR_IMAGES = 20 };

/* What predicts as well as more do, or nearly (docs/notes/components.md). */
static int components_for(int images)
{
    return images < 20 ? 8 : images < 100 ? 16 : 32;
}

/* Whether the options name what only lobes have. */
static bool ask_for_lobes(const weft_compress_options *options)
{
    return options->target_error > 0 || options->budget_bytes > 0 || options->light_table;
}

/* Frames and exponents of lobes ask for them, too, but where images are scattered they are idle beside components. */
static bool shape_lobes(const weft_compress_options *options)
{
    const weft_compress_options usual = weft_compress_default_options();
    return options->frames != usual.frames || options->max_exponent < usual.max_exponent ||
           options->max_exponent > usual.max_exponent;
}

weft_compress_options weft_compress_settle(const weft_compress_options *options, const weft_dataset *dataset)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    weft_compress_options settled = *options;
    if (options->component_count != WEFT_COMPONENTS_AUTOMATIC)
        return settled;
    settled.component_count = 0;
    int images = weft_compress_options_count_images(options, layout);
    bool shared = layout->distance == WEFT_NEAR && images < LEAST_NEAR_IMAGES;
    bool is_grid = !weft_images_are_scattered(layout, options->held_out);
    if (shared || ask_for_lobes(options) || (is_grid && shape_lobes(options)))
        return settled;
    settled.component_count = components_for(images);
    settled.lobe_count = 0;
    settled.table = weft_dataset_has_opacity(dataset);
    return settled;
}

/* What so many samples a texel can carry. T belongs to fixed directions, so that near cameras have none. That of a
 * single view would only be a factor of all terms. */
static void plan(const weft_dataset_layout *layout, const weft_compress_options *options, weft_compress_report *report)
{
    int images = weft_compress_options_count_images(options, layout);
    int lobes = 1 + 4 * options->lobe_count;
    bool table = options->table && layout->distance == WEFT_FAR && layout->view_count > 1 &&
                 layout->view_count <= WEFT_MATERIAL_MAX_VIEWS;
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

weft_compress_model weft_compress_plan(const weft_dataset_layout *layout, const weft_compress_options *options,
                                       int *lobe_count)
{
    weft_compress_report report = {0};
    plan(layout, options, &report);
    *lobe_count = report.lobe_count;
    return report.model;
}

weft_code weft_compress_share_budget(const weft_dataset_layout *whole, const weft_dataset_layout *part,
                                     bool part_has_levels, const weft_compress_options *options, uint64_t *bytes,
                                     weft_error *error)
{
    const double with_levels = 4.0 / 3;
    uint64_t beside_whole, beside_part;
    *bytes = 0;
    if (options->budget_bytes == 0)
        return WEFT_OK;
    WEFT_TRY(weft_compress_metadata_bytes(whole, &beside_whole, error));
    WEFT_TRY(weft_compress_metadata_bytes(part, &beside_part, error));
    beside_whole += options->added_bytes;
    double texels = (double)whole->width * whole->height * (options->levels ? with_levels : 1),
           own = (double)part->width * part->height * (part_has_levels ? with_levels : 1);
    double share = fmin(1, own / texels);
    uint64_t left = options->budget_bytes > beside_whole ? options->budget_bytes - beside_whole : 0;
    *bytes = beside_part + (uint64_t)ceil(share * (double)left);
    return WEFT_OK;
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
             "%s, %d lobes, %d components, maps %d, lights %d, weights %d, frames %d, N <= %.17g, error <= %.17g, "
             "levels %d, held out %08lx",
             weft_compress_model_name(report->model), report->lobe_count, options->component_count,
             (int)options->component_maps, options->light_table, (int)options->weights, (int)options->frames,
             options->max_exponent, options->target_error, options->levels, held_out);
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
    weft_checkpoint *checkpoint; /* that of the dense model, to which the components append */
} fitting;

/* With a target or a budget: which model each texel has is part of the material. */
static weft_code fit_chosen(fitting *work, const weft_texel_source *source, const weft_dense_job *job,
                            weft_material *material, weft_dense_result *result, weft_error *error)
{
    weft_budget_plan plan = {.bytes = work->options->budget_bytes};
    WEFT_TRY(weft_compress_metadata_bytes(source->layout, &plan.reserve, error));
    plan.reserve += work->options->added_bytes;
    if (plan.bytes > 0)
        return weft_budget_fit(work->dataset, source, job, &plan, material, result, error);
    WEFT_TRY(weft_dense_fit(work->dataset, source, job, material, result, error));
    return source->target_error > 0 ? weft_material_find_models(material, error) : WEFT_OK;
}

static weft_code fit_dense(fitting *work, weft_material *material, weft_compress_report *report, weft_error *error)
{
    const weft_compress_options *options = work->options;
    identity_text identity = {0};
    weft_dense_result result = {0};
    WEFT_TRY(weft_given_frames_store(work->dataset, material, error));
    if (options->checkpoint_path)
        WEFT_TRY(identify(work->dataset, options, report, &work->fingerprint, &identity, error));
    weft_dense_job job = {.budget = work->budget,
                          .checkpoint_path = options->checkpoint_path,
                          .identity = {identity.program, identity.dataset, identity.options},
                          .log = options->log,
                          .progress = work->progress};
    weft_texel_source source = {.layout = weft_dataset_get_layout(work->dataset),
                                .held_out = options->held_out,
                                .options = weft_fit_default_options(),
                                .light_table = material->light_count > 0,
                                .weights = options->weights,
                                .frames = options->frames,
                                .target_error = options->target_error};
    if (options->frames == WEFT_FRAMES_GIVEN ||
        (options->frames == WEFT_FRAMES_FITTED && weft_dataset_has_frames(work->dataset)))
        source.given = material;
    source.options.lobe_count = report->lobe_count;
    source.options.table = report->model == WEFT_COMPRESS_TABLE;
    source.options.max_exponent = options->max_exponent;
    weft_code code = fit_chosen(work, &source, &job, material, &result, error);
    work->checkpoint = result.checkpoint;
    WEFT_TRY(code);
    /* What is free is given back to the system, so that writing the material has room. */
    malloc_trim(0);
    work->counts = result.counts;
    report->light_count = material->light_count;
    report->masked_count = result.masked;
    report->block_count = (long)result.block_count;
    report->resumed_block_count = (long)result.resumed_block_count;
    report->read_bytes = (double)result.times.bytes;
    report->read_seconds = result.times.reading;
    report->starved_seconds = result.times.starving;
    return WEFT_OK;
}

/* Fields, their halves and the search of compress/sparse/search.h, from above. */
static uint64_t sparse_bytes(const weft_dataset_layout *layout)
{
    uint64_t texels = (uint64_t)layout->width * (uint64_t)layout->height, threads = (uint64_t)omp_get_max_threads();
    return texels * (64 * (uint64_t)layout->image_count + 128 * threads + 256);
}

static weft_code fit_sparse(fitting *work, weft_material *material, weft_compress_report *report, weft_error *error)
{
    if (work->options->target_error > 0 || work->options->budget_bytes > 0)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "'%s' has too few images to choose a model for each texel: leave out the target or the budget",
                         weft_dataset_path(work->dataset));
    uint64_t bytes = weft_memory_budget_taken(&work->budget) + sparse_bytes(weft_dataset_get_layout(work->dataset));
    if (bytes > work->budget.limit)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "'%s' has so few images that all samples are fitted together: that needs %llu MB of memory, "
                         "more than the limit of %llu MB",
                         weft_dataset_path(work->dataset), (unsigned long long)(bytes / 1000000 + 1),
                         (unsigned long long)(work->budget.limit / 1000000));
    return weft_sparse_material_fit(work->dataset, work->options->held_out, work->progress, material, &work->setting,
                                    &work->counts, &report->masked_count, error);
}

static weft_code fit_components(fitting *work, weft_material *material, weft_compress_report *report, weft_error *error)
{
    weft_components_options options = {.component_count = work->options->component_count,
                                       .maps = work->options->component_maps,
                                       .finer = work->options->finer,
                                       .rounded = work->options->rounded,
                                       .held_out = work->options->held_out,
                                       .for_screen = work->options->weights == WEFT_WEIGHTS_SCREEN,
                                       .budget = work->budget,
                                       .checkpoint = work->checkpoint,
                                       .log = work->options->log};
    return options.component_count > 0
               ? weft_components_fit(work->dataset, &options, work->progress, material, &report->components, error)
               : WEFT_OK;
}

weft_code weft_compress_take_heights(weft_dataset *dataset, weft_material *material, weft_error *error)
{
    weft_dataset_heights surface;
    double size_mm[2];
    if (!material->components)
        return WEFT_OK;
    weft_material_heights *heights = NULL;
    WEFT_TRY(weft_dataset_read_surface(dataset, &surface, error));
    weft_dataset_size_mm(weft_dataset_get_layout(dataset), size_mm);
    weft_code code = WEFT_OK;
    if (surface.value)
        code = weft_material_heights_create(surface.value, surface.width, surface.height, surface.level_count, size_mm,
                                            &heights, error);
    weft_dataset_heights_free(&surface);
    if (heights)
        weft_material_take_heights(material, heights);
    return code;
}

static weft_code fit_material(fitting *work, weft_material *material, weft_compress_report *report, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    WEFT_TRY(weft_dataset_fingerprint_take(work->dataset, &work->fingerprint, error));
    WEFT_TRY(weft_opacity_fill(work->dataset, material, error));
    if (report->model == WEFT_COMPRESS_SPARSE)
        WEFT_TRY(fit_sparse(work, material, report, error));
    else
        WEFT_TRY(fit_dense(work, material, report, error));
    if (work->counts.empty == work->counts.texels && !work->options->held_out) {
        weft_checkpoint_forget(work->checkpoint);
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' holds no valid sample", weft_dataset_path(work->dataset));
    }
    WEFT_TRY(fit_components(work, material, report, error));
    if (work->options->heights)
        WEFT_TRY(weft_compress_take_heights(work->dataset, material, error));
    report->texel_count = work->counts.texels;
    report->empty_texel_count = work->counts.empty;
    report->turned_frame_count = work->counts.turned;
    report->second_start_count = work->counts.second_start;
    report->missed_texel_count = work->counts.missed;
    report->held_texel_count = work->counts.held;
    report->stepped_down_count = work->counts.stepped_down;
    report->sample_count =
        (long)layout->width * layout->height * weft_compress_options_count_images(work->options, layout);
    return weft_compress_describe(layout, work->options, report, &work->fingerprint, &work->setting, material, error);
}

weft_code weft_compress(weft_dataset *dataset, const weft_compress_options *options, const weft_progress *progress,
                        weft_material *material, weft_compress_report *report, weft_error *error)
{
    weft_compress_report own = {0};
    weft_compress_options settled = weft_compress_settle(options, dataset);
    options = &settled;
    double began = weft_now_s();
    WEFT_TRY(weft_compress_options_check(options, dataset, error));
    if (options->component_count > 0)
        WEFT_TRY(
            weft_components_check(options->finer ? 2 * options->component_count : options->component_count, error));
    plan(weft_dataset_get_layout(dataset), options, &own);
    fitting work = {.dataset = dataset,
                    .options = options,
                    .progress = progress,
                    .budget = weft_memory_budget_begin(options->memory_bytes)};
    WEFT_TRY(create_material(weft_dataset_get_layout(dataset), options, &own, material, error));
    weft_code code = fit_material(&work, material, &own, error);
    weft_checkpoint_close(work.checkpoint);
    if (code != WEFT_OK)
        weft_material_free(material);
    own.seconds = weft_now_s() - began;
    if (report)
        *report = own;
    return code;
}
