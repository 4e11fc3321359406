#include "compress/compress.h"

#include "base/clock.h"
#include "base/processor.h"
#include "btf/dataset/fingerprint.h"
#include "compress/components/components_fit.h"
#include "compress/metadata.h"
#include "compress/run/dense.h"
#include "compress/run/frames_and_opacity.h"
#include "compress/run/memory.h"
#include "compress/sparse/sparse.h"

#include <inttypes.h>
#include <malloc.h>
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

weft_compress_options weft_compress_settle(const weft_compress_options *options, const weft_dataset *dataset)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    weft_compress_options settled = *options;
    int images = weft_compress_options_count_images(options, layout);
    bool is_sparse = layout->distance == WEFT_NEAR && images < LEAST_NEAR_IMAGES;
    if (options->component_count == WEFT_COMPONENTS_AUTOMATIC)
        settled.component_count = is_sparse ? 0 : components_for(images);
    return settled;
}

/* T belongs to fixed directions, so that near cameras have none. That of a single view would only be a factor of all
 * terms. */
static bool may_have_table(const weft_dataset_layout *layout)
{
    return layout->distance == WEFT_FAR && layout->view_count > 1 && layout->view_count <= WEFT_MATERIAL_MAX_VIEWS;
}

weft_compress_model weft_compress_plan(const weft_dataset_layout *layout, const weft_compress_options *options,
                                       int *lobe_count)
{
    int images = weft_compress_options_count_images(options, layout), lobes = 1 + 4 * options->lobe_count;
    *lobe_count = 0;
    if (options->component_count > 0)
        return WEFT_COMPRESS_COMPONENTS;
    *lobe_count = options->lobe_count;
    if (options->lobe_count > 0 && may_have_table(layout) &&
        images >= SAMPLES_PER_PARAMETER * (lobes + layout->view_count))
        return WEFT_COMPRESS_TABLE;
    if (images >= SAMPLES_PER_PARAMETER * lobes)
        return WEFT_COMPRESS_LOBES;
    if (images >= SAMPLES_PER_PARAMETER * (1 + 4)) {
        *lobe_count = (images / SAMPLES_PER_PARAMETER - 1) / 4;
        return WEFT_COMPRESS_LOBES;
    }
    *lobe_count = options->lobe_count > 0;
    return WEFT_COMPRESS_SPARSE;
}

/* Opacity lies in the table of views: components have one where the dataset has some. */
static weft_code create_material(const weft_dataset *dataset, const weft_compress_options *options,
                                 const weft_compress_report *report, weft_material *material, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    bool for_opacity = report->model == WEFT_COMPRESS_COMPONENTS && weft_dataset_has_opacity(dataset);
    int views =
        report->model == WEFT_COMPRESS_TABLE || (for_opacity && may_have_table(layout)) ? layout->view_count : 0;
    if (report->model == WEFT_COMPRESS_COMPONENTS)
        WEFT_TRY(
            weft_material_create_without_lobes(layout->width, layout->height, views, options->levels, material, error));
    else
        WEFT_TRY(weft_material_create(layout->width, layout->height, report->lobe_count, views, 0, options->levels,
                                      material, error));
    material->texel_pitch_mm = layout->texel_pitch_mm;
    for (int view = 0; view < views; view++)
        material->view[view] = weft_unit(layout->view[view]);
    for (int k = 0; for_opacity && k < material->level_count && views > 0; k++) {
        const weft_material_level *level = &material->level[k];
        memset(level->table, 255, 4 * (size_t)views * (size_t)level->width * (size_t)level->height);
    }
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
    snprintf(text->options, sizeof text->options, "%s, %d lobes, %d components, weights %d, levels %d, held out %08lx",
             weft_compress_model_name(report->model), report->lobe_count, options->component_count,
             (int)options->weights, options->levels, held_out);
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
    identity_text identity;
    weft_sparse_setting setting;
    weft_checkpoint *checkpoint;
} fitting;

static weft_checkpoint_identity identity_of(const fitting *work)
{
    return (weft_checkpoint_identity){work->identity.program, work->identity.dataset, work->identity.options};
}

static void take_counts(const weft_texel_counts *counts, weft_compress_report *report)
{
    report->texel_count = counts->texels;
    report->empty_texel_count = counts->empty;
}

static weft_code fit_dense(fitting *work, weft_material *material, weft_compress_report *report, weft_error *error)
{
    const weft_compress_options *options = work->options;
    weft_dense_result result = {0};
    WEFT_TRY(weft_given_frames_store(work->dataset, material, error));
    weft_dense_job job = {.budget = work->budget,
                          .checkpoint_path = options->checkpoint_path,
                          .identity = identity_of(work),
                          .log = options->log,
                          .progress = work->progress};
    weft_texel_source source = {.layout = weft_dataset_get_layout(work->dataset),
                                .held_out = options->held_out,
                                .options = weft_fit_default_options(),
                                .weights = options->weights,
                                .given = weft_dataset_has_frames(work->dataset) ? material : NULL};
    source.options.lobe_count = report->lobe_count;
    source.options.table = report->model == WEFT_COMPRESS_TABLE;
    weft_code code = weft_dense_fit(work->dataset, &source, &job, material, &result, error);
    work->checkpoint = result.checkpoint;
    WEFT_TRY(code);
    /* What is free is given back to the system, so that writing the material has room. */
    malloc_trim(0);
    take_counts(&result.counts, report);
    report->masked_count = result.masked;
    return WEFT_OK;
}

/* Fields, their halves and the search of compress/sparse/sparse.h, from above. */
static uint64_t sparse_bytes(const weft_dataset_layout *layout)
{
    uint64_t texels = (uint64_t)layout->width * (uint64_t)layout->height, threads = (uint64_t)omp_get_max_threads();
    return texels * (64 * (uint64_t)layout->image_count + 128 * threads + 256);
}

static weft_code fit_sparse(fitting *work, weft_material *material, weft_compress_report *report, weft_error *error)
{
    uint64_t bytes = weft_memory_budget_taken(&work->budget) + sparse_bytes(weft_dataset_get_layout(work->dataset));
    if (bytes > work->budget.limit)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "'%s' has so few images that all samples are fitted together: that needs %llu MB of memory, "
                         "more than the limit of %llu MB",
                         weft_dataset_path(work->dataset), (unsigned long long)(bytes / 1000000 + 1),
                         (unsigned long long)(work->budget.limit / 1000000));
    weft_texel_counts counts;
    WEFT_TRY(weft_sparse_material_fit(work->dataset, work->options->held_out, work->progress, material, &work->setting,
                                      &counts, &report->masked_count, error));
    take_counts(&counts, report);
    return WEFT_OK;
}

static weft_code open_checkpoint(fitting *work, weft_error *error)
{
    const char *path = work->options->checkpoint_path;
    const weft_checkpoint_identity identity = identity_of(work);
    char why[WEFT_MESSAGE_SIZE];
    if (!path)
        return WEFT_OK;
    WEFT_TRY(weft_checkpoint_open(path, &identity, &work->checkpoint, why, error));
    if (why[0])
        weft_log_line(&work->options->log, why);
    return WEFT_OK;
}

/* The errors of level 0 are those of the texels that the components were learned from. */
static weft_code fit_components(fitting *work, weft_material *material, weft_compress_report *report, weft_error *error)
{
    const weft_compress_options *given = work->options;
    weft_components_report *own = &report->components;
    WEFT_TRY(open_checkpoint(work, error));
    const weft_components_options options = {.component_count = given->component_count,
                                             .finer = given->finer,
                                             .held_out = given->held_out,
                                             .for_screen = given->weights != WEFT_WEIGHTS_EVEN,
                                             .budget = work->budget,
                                             .checkpoint = work->checkpoint,
                                             .log = given->log};
    WEFT_TRY(weft_components_fit(work->dataset, &options, work->progress, material, own, error));
    material->level[0].error = own->fitted;
    report->texel_count = (long)material->level[0].width * material->level[0].height;
    report->empty_texel_count = own->empty_texels;
    report->masked_count = own->masked;
    return given->heights ? weft_compress_take_heights(work->dataset, material, error) : WEFT_OK;
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

static weft_code fit_model(fitting *work, weft_material *material, weft_compress_report *report, weft_error *error)
{
    if (report->model == WEFT_COMPRESS_COMPONENTS)
        return fit_components(work, material, report, error);
    if (report->model == WEFT_COMPRESS_SPARSE)
        return fit_sparse(work, material, report, error);
    return fit_dense(work, material, report, error);
}

static weft_code fit_material(fitting *work, weft_material *material, weft_compress_report *report, weft_error *error)
{
    const weft_compress_options *options = work->options;
    const weft_dataset_layout *layout = weft_dataset_get_layout(work->dataset);
    WEFT_TRY(weft_dataset_fingerprint_take(work->dataset, &work->fingerprint, error));
    if (options->checkpoint_path)
        WEFT_TRY(identify(work->dataset, options, report, &work->fingerprint, &work->identity, error));
    WEFT_TRY(weft_opacity_fill(work->dataset, material, error));
    WEFT_TRY(fit_model(work, material, report, error));
    if (report->empty_texel_count == report->texel_count && !options->held_out) {
        weft_checkpoint_forget(work->checkpoint);
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' holds no valid sample", weft_dataset_path(work->dataset));
    }
    report->sample_count = (long)layout->width * layout->height * weft_compress_options_count_images(options, layout);
    return weft_compress_describe(layout, options, report, &work->fingerprint, &work->setting, material, error);
}

weft_code weft_compress(weft_dataset *dataset, const weft_compress_options *options, const weft_progress *progress,
                        weft_material *material, weft_compress_report *report, weft_error *error)
{
    const weft_compress_options settled = weft_compress_settle(options, dataset);
    weft_compress_report own = {0};
    double began = weft_now_s();
    WEFT_TRY(weft_compress_options_check(&settled, dataset, error));
    own.model = weft_compress_plan(weft_dataset_get_layout(dataset), &settled, &own.lobe_count);
    fitting work = {.dataset = dataset,
                    .options = &settled,
                    .progress = progress,
                    .budget = weft_memory_budget_begin(settled.memory_bytes)};
    WEFT_TRY(create_material(dataset, &settled, &own, material, error));
    weft_code code = fit_material(&work, material, &own, error);
    weft_checkpoint_close(work.checkpoint);
    if (code != WEFT_OK)
        weft_material_free(material);
    own.seconds = weft_now_s() - began;
    if (report)
        *report = own;
    return code;
}

weft_code weft_material_fit(weft_dataset *dataset, const weft_compress_options *options, const weft_progress *progress,
                            weft_material **result, weft_error *error)
{
    const weft_compress_options usual = weft_compress_default_options();
    weft_material *material = malloc(sizeof *material);
    if (!material)
        return weft_fail_memory(error, "material", sizeof *material);
    weft_code code = weft_compress(dataset, options ? options : &usual, progress, material, NULL, error);
    if (code == WEFT_OK)
        *result = material;
    else
        free(material);
    return code;
}
