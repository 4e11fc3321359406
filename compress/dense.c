#include "compress/dense.h"

#include "btf/processor.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { TILE_BYTES = 32 << 20 };

/* A rectangle of texels of one level with the sums of their groups' samples. */
typedef struct grid {
    int level, x, y, width, height; /* place in the level */
    float *sum;                     /* [height][width][image_count][3] */
    float *count;                   /* [height][width][image_count] valid texels of level 0 */
} grid;

/* One run over a dataset. */
typedef struct run {
    weft_dataset *dataset;
    const weft_texel_source *source;
    const weft_progress *progress;
    weft_material *material;
    int thread_count;
    weft_texel_fitter **fitter;                         /* [thread_count] */
    weft_error_tally *tally[WEFT_MATERIAL_MAX_LEVELS];  /* by level */
    weft_texel_counts counts[WEFT_MATERIAL_MAX_LEVELS]; /* by level */
    long masked, done, total;
} run;

static weft_code create_grid(int level, int x, int y, int width, int height, int image_count, grid *grid_of,
                             weft_error *error)
{
    *grid_of = (grid){.level = level, .x = x, .y = y, .width = width, .height = height};
    size_t samples = (size_t)width * (size_t)height * (size_t)image_count;
    grid_of->sum = calloc(3 * samples, sizeof(float));
    grid_of->count = calloc(samples, sizeof(float));
    if (grid_of->sum && grid_of->count)
        return WEFT_OK;
    free(grid_of->sum);
    free(grid_of->count);
    *grid_of = (grid){0};
    return weft_fail_memory(error, "samples of a tile", 4 * samples * sizeof(float));
}

static void free_grid(grid *grid_of)
{
    free(grid_of->sum);
    free(grid_of->count);
    *grid_of = (grid){0};
}

/* ---- Fitting a grid ---- */

static void fit_row(run *job, const grid *from, int row, weft_texel_counts *counts)
{
    size_t images = (size_t)job->source->layout->image_count;
    weft_texel_fitter *fitter = job->fitter[omp_get_thread_num()];
    for (int x = 0; x < from->width; x++) {
        size_t texel = (size_t)row * (size_t)from->width + (size_t)x;
        weft_texel_fit(fitter, job->material, from->level, from->x + x, from->y + row, from->sum + 3 * texel * images,
                       from->count + texel * images, counts);
    }
}

static void add_counts(weft_texel_counts *to, const weft_texel_counts *from)
{
    to->texels += from->texels;
    to->empty += from->empty;
    to->turned += from->turned;
    to->second_start += from->second_start;
    weft_error_sums_add(&to->sums, &from->sums);
}

/* Rows are independent; what they counted is added in their order, so that the number of threads leaves no trace. */
static weft_code fit_grid(run *job, const grid *from, weft_error *error)
{
    weft_texel_counts *rows = calloc((size_t)from->height, sizeof *rows);
    if (!rows)
        return weft_fail_memory(error, "counts of rows", (size_t)from->height * sizeof *rows);
#pragma omp parallel for schedule(dynamic) num_threads(job->thread_count)
    for (int row = 0; row < from->height; row++) {
        unsigned state = weft_denormals_off();
        fit_row(job, from, row, &rows[row]);
        weft_denormals_restore(state);
    }
    for (int row = 0; row < from->height; row++)
        add_counts(&job->counts[from->level], &rows[row]);
    for (int thread = 0; thread < job->thread_count; thread++)
        weft_error_tally_merge(job->tally[from->level], weft_texel_fitter_tally(job->fitter[thread]));
    free(rows);
    job->done += (long)from->width * from->height;
    weft_progress_report(job->progress, "fitting texels", job->done, job->total);
    return WEFT_OK;
}

/* ---- Sums ---- */

/* Adds texel (x, y) of `from` to the group it belongs to. */
static void add_to_group(const grid *from, int x, int y, int image_count, const grid *to)
{
    size_t images = (size_t)image_count;
    size_t child = (size_t)y * (size_t)from->width + (size_t)x;
    size_t group = (size_t)((from->y + y) / 2 - to->y) * (size_t)to->width + (size_t)((from->x + x) / 2 - to->x);
    const float *sum = from->sum + 3 * child * images, *count = from->count + child * images;
    float *group_sum = to->sum + 3 * group * images, *group_count = to->count + group * images;
    for (size_t i = 0; i < images; i++) {
        group_count[i] += count[i];
        for (size_t k = 0; k < 3; k++)
            group_sum[3 * i + k] += sum[3 * i + k];
    }
}

static weft_code reduce_grid(const run *job, const grid *from, grid *to, weft_error *error)
{
    int images = job->source->layout->image_count, x = from->x / 2, y = from->y / 2;
    int width = (from->x + from->width + 1) / 2 - x, height = (from->y + from->height + 1) / 2 - y;
    WEFT_TRY(create_grid(from->level + 1, x, y, width, height, images, to, error));
    for (int row = 0; row < from->height; row++) {
        for (int column = 0; column < from->width; column++)
            add_to_group(from, column, row, images, to);
    }
    return WEFT_OK;
}

/* Half floats and masks to sums of one texel each; not-finite samples count as masked. */
static void spread_samples(run *job, const weft_half *samples, const uint8_t *mask, const grid *to)
{
    const weft_texel_source *source = job->source;
    size_t images = (size_t)source->layout->image_count, texels = (size_t)to->width * (size_t)to->height;
    for (size_t i = 0; i < texels * images; i++) {
        size_t image = i % images;
        float rgb[3];
        bool valid = mask[i] == 0;
        for (size_t k = 0; k < 3; k++) {
            rgb[k] = weft_float_of_half(samples[3 * i + k]);
            valid = valid && isfinite(rgb[k]);
        }
        if (source->held_out && source->held_out[image])
            continue;
        job->masked += !valid;
        to->count[i] = valid;
        for (size_t k = 0; k < 3; k++)
            to->sum[3 * i + k] = valid ? rgb[k] : 0;
    }
}

static weft_code read_tile(run *job, int x, int y, int width, int height, grid *tile, weft_error *error)
{
    size_t images = (size_t)job->source->layout->image_count, samples = (size_t)width * (size_t)height * images;
    weft_half *half = malloc(3 * samples * sizeof *half);
    uint8_t *mask = malloc(samples);
    weft_code code = WEFT_OK;
    if (!half || !mask)
        code = weft_fail_memory(error, "block of the dataset", 7 * samples);
    if (code == WEFT_OK)
        code = create_grid(0, x, y, width, height, (int)images, tile, error);
    if (code == WEFT_OK)
        code = weft_dataset_read_block(job->dataset, x, y, width, height, half, mask, error);
    if (code == WEFT_OK)
        spread_samples(job, half, mask, tile);
    free(half);
    free(mask);
    return code;
}

/* ---- Levels ---- */

/* Fits `from` and the levels above it up to `last`; the sums of level `last` replace `from`. */
static weft_code climb(run *job, grid *from, int last, weft_error *error)
{
    weft_code code = fit_grid(job, from, error);
    while (code == WEFT_OK && from->level < last) {
        grid above = {0};
        code = reduce_grid(job, from, &above, error);
        free_grid(from);
        *from = above;
        if (code == WEFT_OK)
            code = fit_grid(job, from, error);
    }
    return code;
}

/* log2 of the side of a tile: about TILE_BYTES of sums. */
static int tile_level(const weft_dataset_layout *layout, int level_count)
{
    size_t texel_bytes = (size_t)layout->image_count * 4 * sizeof(float);
    int level = 0;
    while (level + 1 < level_count && level < 6 && (texel_bytes << (2 * (level + 1))) <= TILE_BYTES)
        level++;
    return level;
}

static int whole_tiles(int texels, int level)
{
    return (texels + (1 << level) - 1) >> level;
}

/* Fits the levels of one tile and keeps the sums of its one group in `top`. */
static weft_code fit_tile(run *job, int column, int row, int level, const grid *top, weft_error *error)
{
    const weft_dataset_layout *layout = job->source->layout;
    int x = column << level, y = row << level, side = 1 << level;
    int width = layout->width - x < side ? layout->width - x : side;
    int height = layout->height - y < side ? layout->height - y : side;
    grid tile = {0};
    weft_code code = read_tile(job, x, y, width, height, &tile, error);
    if (code == WEFT_OK)
        code = climb(job, &tile, top ? level : 0, error);
    if (code == WEFT_OK && top) {
        size_t images = (size_t)layout->image_count, group = (size_t)row * (size_t)top->width + (size_t)column;
        memcpy(top->sum + 3 * group * images, tile.sum, 3 * images * sizeof(float));
        memcpy(top->count + group * images, tile.count, images * sizeof(float));
    }
    free_grid(&tile);
    return code;
}

static weft_code fit_tiles(run *job, int level, const grid *top, weft_error *error)
{
    const weft_dataset_layout *layout = job->source->layout;
    for (int row = 0; row < whole_tiles(layout->height, level); row++) {
        for (int column = 0; column < whole_tiles(layout->width, level); column++)
            WEFT_TRY(fit_tile(job, column, row, level, top, error));
    }
    return WEFT_OK;
}

static weft_code fit_levels(run *job, weft_error *error)
{
    const weft_dataset_layout *layout = job->source->layout;
    int last = job->material->level_count - 1;
    if (last == 0)
        return fit_tiles(job, tile_level(layout, WEFT_MATERIAL_MAX_LEVELS), NULL, error);
    int level = tile_level(layout, job->material->level_count);
    grid top, above = {0};
    WEFT_TRY(create_grid(level, 0, 0, whole_tiles(layout->width, level), whole_tiles(layout->height, level),
                         layout->image_count, &top, error));
    weft_code code = fit_tiles(job, level, &top, error);
    if (code == WEFT_OK && level < last) {
        code = reduce_grid(job, &top, &above, error);
        if (code == WEFT_OK)
            code = climb(job, &above, last, error);
    }
    free_grid(&top);
    free_grid(&above);
    return code;
}

static weft_code create_run(run *job, weft_error *error)
{
    for (int k = 0; k < job->material->level_count; k++) {
        WEFT_TRY(weft_error_tally_create(&job->tally[k], error));
        job->total += (long)job->material->level[k].width * job->material->level[k].height;
    }
    job->thread_count = omp_get_max_threads();
    job->fitter = calloc((size_t)job->thread_count, sizeof *job->fitter);
    if (!job->fitter)
        return weft_fail_memory(error, "texel fitters", (size_t)job->thread_count * sizeof *job->fitter);
    for (int i = 0; i < job->thread_count; i++)
        WEFT_TRY(weft_texel_fitter_create(job->source, &job->fitter[i], error));
    return WEFT_OK;
}

static void free_run(run *job)
{
    for (int i = 0; job->fitter && i < job->thread_count; i++)
        weft_texel_fitter_free(job->fitter[i]);
    free(job->fitter);
    for (int k = 0; k < WEFT_MATERIAL_MAX_LEVELS; k++)
        weft_error_tally_free(job->tally[k]);
}

weft_code weft_dense_fit(weft_dataset *dataset, const weft_texel_source *source, const weft_progress *progress,
                         weft_material *material, weft_texel_counts *counts, long *masked_count, weft_error *error)
{
    run job = {.dataset = dataset, .source = source, .progress = progress, .material = material};
    weft_code code = create_run(&job, error);
    if (code == WEFT_OK)
        code = fit_levels(&job, error);
    *counts = (weft_texel_counts){0};
    for (int k = 0; code == WEFT_OK && k < material->level_count; k++) {
        material->level[k].error = weft_error_result(job.tally[k], &job.counts[k].sums);
        add_counts(counts, &job.counts[k]);
    }
    *masked_count = job.masked;
    free_run(&job);
    return code;
}
