#include "compress/run/dense.h"

#include "base/processor.h"
#include "compress/run/fitted.h"
#include "compress/run/mip_pyramid.h"

#include <omp.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAX_SIDE_LEVEL = 6,
    BLOCK_BYTES = 16 << 20, /* of samples and masks: larger ones are not read faster, and are more to lose */
    SPARE_BYTES = 12 << 20  /* HDF5's own structures, stacks of threads, one record, what malloc wastes; zstd */
};

/* A thread that fits, and what it has gathered of the present block. */
typedef struct worker {
    weft_texel_fitter *fitter;
    weft_texel_counts counts;
    long masked;
    int level; /* of the errors in the fitter's tally */
} worker;

/* One run over a dataset. */
typedef struct run {
    weft_dataset *dataset;
    const weft_texel_source *source;
    const weft_dense_job *job;
    int thread_count;
    worker *worker; /* [thread_count] */
    weft_thread_pool *pool;
    pthread_mutex_t mutex; /* of fitted.block_tally */
    weft_fitted fitted;
    weft_block_plan plan;
    weft_pyramid pyramid;
    weft_checkpoint *checkpoint;
    weft_block_reader *reader;
    uint64_t library_bytes; /* that HDF5 may take */
} run;

/* ---- Fitting a block ---- */

/* The texels of a block, level after level. */
typedef struct work_list {
    run *fit;
    const weft_block_samples *block;
    struct {
        long first; /* number of the level's first texel */
        weft_block_place place;
    } range[WEFT_MATERIAL_MAX_LEVELS]; /* by level */
    int range_count;
    long count;
} work_list;

static work_list list_work(run *fit, const weft_block_samples *block, int finished)
{
    work_list list = {.fit = fit, .block = block, .range_count = finished + 1};
    for (int k = 0; k <= finished; k++) {
        list.range[k].place = weft_block_place_at(&block->place, k);
        list.range[k].first = list.count;
        list.count += (long)list.range[k].place.width * list.range[k].place.height;
    }
    return list;
}

/* Errors come level by level: those of another level must have been handed over before. */
static void hand_over_tally(run *fit, worker *who)
{
    pthread_mutex_lock(&fit->mutex);
    weft_error_tally_merge(fit->fitted.block_tally[who->level], weft_texel_fitter_tally(who->fitter));
    pthread_mutex_unlock(&fit->mutex);
}

/* The group of a texel: of level 0 from its samples, else from the pyramid. */
static const float *find_group(run *fit, const weft_block_samples *block, int level, int x, int y, int thread)
{
    if (level > 0)
        return weft_pyramid_group(&fit->pyramid, &block->place, level, x, y);
    size_t images = fit->pyramid.image_count;
    size_t texel = (size_t)(y - block->place.y) * (size_t)block->place.width + (size_t)(x - block->place.x);
    float *group = fit->pyramid.scratch + (size_t)thread * 4 * images;
    fit->worker[thread].masked += weft_group_of_texel(block->samples + 3 * texel * images, block->mask + texel * images,
                                                      fit->source->held_out, images, group);
    return group;
}

static void fit_texel(run *fit, const weft_block_samples *block, int level, int x, int y, int thread)
{
    worker *who = &fit->worker[thread];
    weft_material *material = fit->fitted.material;
    if (who->level != level)
        hand_over_tally(fit, who);
    who->level = level;
    const float *group = find_group(fit, block, level, x, y, thread);
    who->counts.sums = (weft_error_sums){0};
    unsigned state = weft_denormals_off();
    weft_texel_fit(who->fitter, material, level, x, y, group, group + 3 * fit->pyramid.image_count, &who->counts);
    weft_denormals_restore(state);
    fit->fitted.sums[level][(size_t)y * (size_t)material->level[level].width + (size_t)x] = who->counts.sums;
}

static void fit_item(void *context, long item, int thread)
{
    const work_list *list = context;
    int i = list->range_count - 1;
    while (list->range[i].first > item)
        i--;
    const weft_block_place *place = &list->range[i].place;
    long index = item - list->range[i].first;
    fit_texel(list->fit, list->block, i, place->x + (int)(index % place->width), place->y + (int)(index / place->width),
              thread);
}

static void fit_texels(run *fit, const weft_block_samples *block, int finished)
{
    work_list list = list_work(fit, block, finished);
    weft_thread_pool_run(fit->pool, fit_item, &list, list.count);
    for (int thread = 0; thread < fit->thread_count; thread++) {
        worker *who = &fit->worker[thread];
        hand_over_tally(fit, who);
        weft_fitted_add_counts(&fit->fitted.block_counts, &who->counts);
        fit->fitted.block_masked += who->masked;
        *who = (worker){.fitter = who->fitter};
    }
}

/* ---- Checkpoints ---- */

/* Everything that the rest of the run needs of a block. */
static void transfer_block(run *fit, size_t index, weft_record *record)
{
    weft_fitted_transfer_block(&fit->fitted, &fit->plan.place[index], fit->plan.finished[index], record);
    float *top = weft_pyramid_top(&fit->pyramid);
    if (top)
        weft_record_transfer(record, top, 4 * fit->pyramid.image_count * sizeof *top);
}

static void end_block(run *fit, size_t index)
{
    weft_pyramid_clear_finished(&fit->pyramid, fit->plan.finished[index]);
    weft_fitted_end_block(&fit->fitted);
}

static weft_code save_block(run *fit, size_t index, weft_error *error)
{
    if (!fit->checkpoint)
        return WEFT_OK;
    weft_record record = {0};
    transfer_block(fit, index, &record);
    weft_code code = record.failed ? weft_fail_memory(error, "record of a block", record.size)
                                   : weft_checkpoint_append(fit->checkpoint, &record, error);
    free(record.bytes);
    return code;
}

static weft_code load_block(run *fit, size_t index, weft_error *error)
{
    weft_record record = {0};
    weft_code code = weft_checkpoint_read(fit->checkpoint, &record, error);
    if (code == WEFT_OK) {
        transfer_block(fit, index, &record);
        if (record.failed || record.at != record.size)
            code = weft_fail(error, WEFT_BAD_INPUT, "'%s': record %zu does not fit its block; remove the file",
                             fit->job->checkpoint_path, index);
    }
    free(record.bytes);
    WEFT_TRY(code);
    weft_pyramid_pass_up(&fit->pyramid, fit->plan.finished[index]);
    end_block(fit, index);
    return WEFT_OK;
}

static weft_code resume(run *fit, size_t *done, weft_error *error)
{
    *done = 0;
    if (!fit->job->checkpoint_path)
        return WEFT_OK;
    char text[WEFT_MESSAGE_SIZE], options[512];
    weft_checkpoint_identity identity = fit->job->identity;
    snprintf(options, sizeof options, "%s, blocks of 2^%d texels", identity.options, fit->plan.side_level);
    identity.options = options;
    WEFT_TRY(weft_checkpoint_open(fit->job->checkpoint_path, &identity, &fit->checkpoint, text, error));
    if (text[0])
        weft_log_line(&fit->job->log, text);
    for (; *done < fit->plan.count && weft_checkpoint_unread(fit->checkpoint) > 0; (*done)++)
        WEFT_TRY(load_block(fit, *done, error));
    if (*done > 0) {
        snprintf(text, sizeof text, "going on after %zu of %zu blocks, kept in %s", *done, fit->plan.count,
                 fit->job->checkpoint_path);
        weft_log_line(&fit->job->log, text);
    }
    return WEFT_OK;
}

/* ---- The plan ---- */

static size_t block_texels(const weft_dataset_layout *layout, int side_level)
{
    size_t side = (size_t)1 << side_level, width = (size_t)layout->width, height = (size_t)layout->height;
    return (side < width ? side : width) * (side < height ? side : height);
}

/* Of a texel, as far as it is fitted. */
static uint64_t packed_bytes(const weft_material *material)
{
    return sizeof(int16_t) * 3 + sizeof(weft_half) * 4 * (1 + 3 * (uint64_t)material->lobe_count) +
           4 * (uint64_t)material->view_count;
}

static long all_texels(const weft_material *material)
{
    long texels = 0;
    for (int k = 0; k < material->level_count; k++)
        texels += (long)material->level[k].width * material->level[k].height;
    return texels;
}

/* What blocks of 2^side_level texels take. */
static uint64_t block_bytes(const run *fit, int side_level)
{
    const weft_dataset_layout *layout = fit->source->layout;
    const weft_material *material = fit->fitted.material;
    size_t texels = block_texels(layout, side_level);
    /* Texels of all levels, and a buffer that grows. */
    uint64_t record = 3 * texels * (packed_bytes(material) + sizeof(weft_error_sums));
    return weft_block_reader_bytes(layout, texels) +
           weft_pyramid_bytes((size_t)layout->image_count, side_level, material->level_count - 1, fit->thread_count) +
           record;
}

/* The largest blocks that the budget and good sense allow. */
static weft_code choose_side(const run *fit, int *side_level, weft_error *error)
{
    const weft_dataset_layout *layout = fit->source->layout;
    const weft_memory_budget *budget = &fit->job->budget;
    const weft_material *material = fit->fitted.material;
    uint64_t material_bytes = (uint64_t)all_texels(material) * packed_bytes(material);
    int last = material->level_count - 1, most = last > 0 && last < MAX_SIDE_LEVEL ? last : MAX_SIDE_LEVEL;
    uint64_t taken = weft_memory_budget_taken(budget) + fit->library_bytes + SPARE_BYTES;
    uint64_t writing = taken + material_bytes;
    uint64_t least = taken + block_bytes(fit, 0) > writing ? taken + block_bytes(fit, 0) : writing;
    if (least > budget->limit)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "'%s' needs %llu MB of memory at least with %d threads (the material %llu MB), more than the "
                         "limit of %llu MB",
                         weft_dataset_path(fit->dataset), (unsigned long long)(least / 1000000 + 1), fit->thread_count,
                         (unsigned long long)(material_bytes / 1000000), (unsigned long long)(budget->limit / 1000000));
    *side_level = 0;
    while (*side_level < most &&
           weft_block_reader_bytes(layout, block_texels(layout, *side_level + 1)) <= 2 * BLOCK_BYTES &&
           taken + block_bytes(fit, *side_level + 1) <= budget->limit)
        (*side_level)++;
    return WEFT_OK;
}

static weft_code create_workers(run *fit, weft_error *error)
{
    fit->thread_count = omp_get_max_threads();
    fit->worker = calloc((size_t)fit->thread_count, sizeof *fit->worker);
    if (!fit->worker)
        return weft_fail_memory(error, "texel fitters", (size_t)fit->thread_count * sizeof *fit->worker);
    for (int i = 0; i < fit->thread_count; i++)
        WEFT_TRY(weft_texel_fitter_create(fit->source, &fit->worker[i].fitter, error));
    return weft_thread_pool_create(fit->thread_count, &fit->pool, error);
}

/* The fitters are made first, so that the plan knows what they take. */
static weft_code create_run(run *fit, weft_material *material, weft_error *error)
{
    const weft_dataset_layout *layout = fit->source->layout;
    int side_level, last = material->level_count - 1;
    WEFT_TRY(weft_dataset_limit_cache(fit->dataset, &fit->library_bytes, error));
    WEFT_TRY(create_workers(fit, error));
    WEFT_TRY(weft_fitted_create(material, &fit->fitted, error));
    WEFT_TRY(choose_side(fit, &side_level, error));
    WEFT_TRY(weft_block_plan_create(layout->width, layout->height, side_level, last, &fit->plan, error));
    return weft_pyramid_create(&fit->plan, fit->source->held_out, (size_t)layout->image_count, fit->thread_count,
                               &fit->pyramid, error);
}

static void free_run(run *fit)
{
    weft_block_reader_free(fit->reader);
    weft_checkpoint_close(fit->checkpoint);
    weft_pyramid_free(&fit->pyramid);
    weft_block_plan_free(&fit->plan);
    weft_fitted_free(&fit->fitted);
    weft_thread_pool_free(fit->pool);
    for (int i = 0; fit->worker && i < fit->thread_count; i++)
        weft_texel_fitter_free(fit->worker[i].fitter);
    free(fit->worker);
    pthread_mutex_destroy(&fit->mutex);
}

/* ---- The whole ---- */

static weft_code fit_block(run *fit, size_t index, weft_error *error)
{
    const weft_block_samples *block;
    int finished = fit->plan.finished[index];
    WEFT_TRY(weft_block_reader_next(fit->reader, &block, error));
    weft_pyramid_sum_block(&fit->pyramid, fit->pool, block);
    weft_pyramid_pass_up(&fit->pyramid, finished);
    fit_texels(fit, block, finished);
    WEFT_TRY(save_block(fit, index, error));
    end_block(fit, index);
    return WEFT_OK;
}

static weft_code fit_blocks(run *fit, weft_error *error)
{
    const weft_block_plan *plan = &fit->plan;
    size_t first;
    WEFT_TRY(resume(fit, &first, error));
    long resumed = fit->fitted.counts.texels, total = all_texels(fit->fitted.material) - resumed;
    WEFT_TRY(weft_block_reader_create(fit->dataset, plan->place + first, plan->count - first,
                                      block_texels(fit->source->layout, plan->side_level), &fit->reader, error));
    weft_progress_report(fit->job->progress, "fitting texels", 0, total);
    for (size_t i = first; i < plan->count; i++) {
        WEFT_TRY(fit_block(fit, i, error));
        weft_progress_report(fit->job->progress, "fitting texels", fit->fitted.counts.texels - resumed, total);
    }
    return WEFT_OK;
}

weft_code weft_dense_fit(weft_dataset *dataset, const weft_texel_source *source, const weft_dense_job *job,
                         weft_material *material, weft_dense_result *result, weft_error *error)
{
    *result = (weft_dense_result){0};
    run fit = {.dataset = dataset, .source = source, .job = job};
    pthread_mutex_init(&fit.mutex, NULL);
    weft_code code = create_run(&fit, material, error);
    if (code == WEFT_OK)
        code = fit_blocks(&fit, error);
    if (code == WEFT_OK) {
        weft_fitted_finish(&fit.fitted);
        result->counts = fit.fitted.counts;
        result->masked = fit.fitted.masked;
        result->checkpoint = fit.checkpoint;
        fit.checkpoint = NULL;
    }
    free_run(&fit);
    return code;
}
