#include "compress/components/projection.h"

#include "base/real.h"
#include "base/thread_pool.h"
#include "btf/material/components.h"
#include "compress/run/block_plan.h"
#include "compress/run/checkpoint.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>

/* Texels that are projected together, for the sake of the tiles of compress/components/dot_kernel.c. */
enum { BATCH = 4, ALIGNMENT = 64, MOST_SIDE_LEVEL = 6, BLOCK_BYTES = 16 << 20 };

/* What a thread needs of its own. */
typedef struct worker {
    weft_near_projector near_projector; /* of near images */
    float *vector;                      /* [BATCH][length] */
    float *scratch;                     /* [4 dataset images] */
    uint8_t *known;                     /* [BATCH][images] */
    weft_error error;
    weft_code code;
    long masked, empty;
} worker;

typedef struct run {
    const weft_component_images *images;
    const weft_projector *projector; /* NULL: every texel has factors of its own */
    const weft_factorisation *components;
    const weft_component_maps *maps;
    weft_projection *projection;
    const weft_block_samples *block;
    int thread_count;
    worker *worker;
} run;

void weft_projection_free(weft_projection *projection)
{
    free(projection->coefficient);
    free(projection->brightest);
    free(projection->floor);
    *projection = (weft_projection){0};
}

/* ---- How dark the samples of a texel get ---- */

/* So many of 1000 valid samples of a texel may be darker than its floor: noise, and what lies in a hard shadow. */
enum { CODES = 256, WHOLE = 1000, RUN = 64, DARKER_OF_1000 = 20, LEAST_IMAGES_OF_A_FLOOR = 50 };

/* The code that so many samples at most lie below, by a histogram over the codes. */
static uint8_t code_above(const int count[CODES], int below)
{
    int code = 0;
    for (int sum = count[0]; sum <= below && code < CODES - 1; sum += count[code])
        code++;
    return (uint8_t)code;
}

/* The codes of so many images. */
WEFT_HOT static void find_codes(const weft_component_images *images, const float *vector, size_t first, size_t length,
                                uint8_t code[3 * RUN])
{
    float divisor[3 * RUN];
    for (size_t i = 0; i < length; i++) {
        float of_image = images->weight[first + i] * images->height[first + i];
        divisor[3 * i] = divisor[3 * i + 1] = divisor[3 * i + 2] = of_image;
    }
    for (size_t i = 0; i < 3 * length; i++)
        code[i] = weft_floor_code(vector[3 * first + i] / divisor[i]);
}

/* The reflectance in each channel that all but 2 % of the valid samples reach, rounded down to what weft_floor_of_code
 * gives; 0 where there are too few. */
static void find_floor(const weft_component_images *images, const float *vector, const uint8_t *known, float floor[3])
{
    int count[3][CODES] = {{0}}, samples = 0;
    size_t all = (size_t)images->image_count;
    for (size_t first = 0; first < all; first += RUN) {
        uint8_t code[3 * RUN];
        size_t length = all - first < RUN ? all - first : RUN;
        find_codes(images, vector, first, length, code);
        for (size_t i = 0; i < length; i++) {
            int is_valid = known[first + i] == WEFT_SAMPLE_VALID;
            samples += is_valid;
            for (size_t c = 0; c < 3; c++)
                count[c][code[3 * i + c]] += is_valid;
        }
    }
    int below = (int)((long)samples * DARKER_OF_1000 / WHOLE);
    for (int c = 0; c < 3; c++)
        floor[c] = samples < LEAST_IMAGES_OF_A_FLOOR ? 0 : weft_floor_of_code(code_above(count[c], below));
}

/* ---- A block ---- */

/* Of numbers: fmaxf, which is a call, looks for what is none. */
static float larger(float a, float b)
{
    return a > b ? a : b;
}

static float brightest(const weft_component_images *images, const float *vector)
{
    float most = 0;
    for (size_t i = 0; i < (size_t)images->image_count; i++) {
        float largest = larger(vector[3 * i], larger(vector[3 * i + 1], vector[3 * i + 2]));
        most = larger(most, largest / images->weight[i]);
    }
    return most;
}

/* In place. Weights are of roots of squares: w (v / w). */
WEFT_HOT static void code_samples(float exponent, const float *weight, size_t count, float *vector)
{
    float inverse = 1 / exponent;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++)
            vector[3 * i + c] = weight[i] * weft_power(vector[3 * i + c] / weight[i], inverse);
}

static void gather(const run *r, const weft_component_images *seen, worker *own, long first, int count)
{
    const weft_block_samples *block = r->block;
    size_t images = (size_t)r->images->image_count, all = (size_t)r->images->dataset_image_count;
    for (size_t i = 0; i < (size_t)count; i++) {
        size_t at = (size_t)first + i, x = at % (size_t)block->place.width, y = at / (size_t)block->place.width;
        float *vector = own->vector + i * r->images->length;
        int valid = weft_component_images_gather(seen, block->samples + 3 * all * at, block->mask + all * at,
                                                 own->scratch, vector, own->known + i * images);
        own->masked += r->images->image_count - valid;
        own->empty += valid == 0;
        size_t texel = ((size_t)block->place.y + y) * (size_t)r->projection->width + (size_t)block->place.x + x;
        r->projection->brightest[texel] = brightest(r->images, vector);
        find_floor(seen, vector, own->known + i * images, r->projection->floor + 3 * texel);
        if (r->maps->components->exponent != 1)
            code_samples(r->maps->components->exponent, r->images->weight, images, vector);
    }
}

/* Coefficients of texels of the block. */
static weft_code solve_alike(const run *r, worker *own, long first, int count, float *coefficient)
{
    const float *vector[BATCH] = {0};
    const uint8_t *known[BATCH] = {0};
    gather(r, r->images, own, first, count);
    for (size_t i = 0; i < (size_t)count; i++) {
        vector[i] = own->vector + i * r->images->length;
        known[i] = own->known + i * (size_t)r->images->image_count;
    }
    return weft_projector_solve(r->projector, vector, known, count, coefficient, &own->error);
}

static weft_code solve_each(const run *r, worker *own, long first, int count, float *coefficient)
{
    const weft_block_place *place = &r->block->place;
    for (int i = 0; i < count; i++) {
        int x = (int)((first + i) % place->width), y = (int)((first + i) / place->width);
        weft_near_projector_move(&own->near_projector, place->x + x, place->y + y);
        gather(r, &own->near_projector.images, own, first + i, 1);
        WEFT_TRY(weft_near_projector_solve(&own->near_projector, own->vector, own->known,
                                           coefficient + i * r->components->count, &own->error));
    }
    return WEFT_OK;
}

static void project_batch(void *context, long item, int thread)
{
    run *r = context;
    worker *own = &r->worker[thread];
    const weft_block_samples *block = r->block;
    long texels = (long)block->place.width * block->place.height, first = item * BATCH;
    int count = texels - first < BATCH ? (int)(texels - first) : BATCH, components = r->components->count;
    float coefficient[BATCH * WEFT_COMPONENTS_MAX] = {0};
    weft_code code =
        r->projector ? solve_alike(r, own, first, count, coefficient) : solve_each(r, own, first, count, coefficient);
    own->code = own->code == WEFT_OK ? code : own->code;
    for (int i = 0; i < count; i++) {
        size_t x = (size_t)(first + i) % (size_t)block->place.width + (size_t)block->place.x;
        size_t y = (size_t)(first + i) / (size_t)block->place.width + (size_t)block->place.y;
        float *to = r->projection->coefficient + (y * (size_t)r->projection->width + x) * (size_t)components;
        for (int k = 0; k < components; k++)
            to[k] = coefficient[i * components + k];
    }
}

/* ---- Blocks in the checkpoint of a compression ---- */

/* What was counted belongs to all blocks so far. */
static void transfer_block(weft_projection *projection, const weft_block_place *place, weft_record *record)
{
    size_t columns = (size_t)place->width, components = (size_t)projection->component_count;
    for (int y = place->y; y < place->y + place->height; y++) {
        size_t first = (size_t)y * (size_t)projection->width + (size_t)place->x;
        weft_record_transfer(record, projection->coefficient + first * components,
                             columns * components * sizeof(float));
        weft_record_transfer(record, projection->brightest + first, columns * sizeof(float));
        weft_record_transfer(record, projection->floor + 3 * first, 3 * columns * sizeof(float));
    }
    weft_record_transfer(record, &projection->masked, sizeof projection->masked);
    weft_record_transfer(record, &projection->empty, sizeof projection->empty);
}

static weft_code take_block(weft_checkpoint *checkpoint, const weft_block_place *place, weft_projection *projection,
                            weft_error *error)
{
    weft_record record = {0};
    weft_code code = weft_checkpoint_read(checkpoint, &record, error);
    if (code == WEFT_OK) {
        transfer_block(projection, place, &record);
        if (record.failed || record.at != record.size)
            code =
                weft_fail(error, WEFT_BAD_INPUT, "'%s': a record of components does not fit its block; remove the file",
                          weft_checkpoint_path(checkpoint));
    }
    free(record.bytes);
    return code;
}

/* Fills the projection with the blocks of `plan` that are kept and unread, and says how many they are. */
static weft_code take_kept_blocks(weft_checkpoint *checkpoint, const weft_log *log, const weft_block_plan *plan,
                                  weft_projection *projection, size_t *count, weft_error *error)
{
    *count = 0;
    if (!checkpoint)
        return WEFT_OK;
    for (; *count < plan->count && weft_checkpoint_unread(checkpoint) > 0; (*count)++)
        WEFT_TRY(take_block(checkpoint, &plan->place[*count], projection, error));
    if (*count > 0) {
        char text[WEFT_MESSAGE_SIZE];
        snprintf(text, sizeof text, "going on after %zu of %zu blocks of components, kept in %s", *count, plan->count,
                 weft_checkpoint_path(checkpoint));
        weft_log_line(log, text);
    }
    return WEFT_OK;
}

static weft_code keep_block(weft_checkpoint *checkpoint, weft_projection *projection, const weft_block_place *place,
                            weft_error *error)
{
    if (!checkpoint)
        return WEFT_OK;
    weft_record record = {0};
    transfer_block(projection, place, &record);
    weft_code code = record.failed ? weft_fail_memory(error, "record of a block", record.size)
                                   : weft_checkpoint_append(checkpoint, &record, error);
    free(record.bytes);
    return code;
}

/* ---- The run ---- */

static void free_workers(run *r)
{
    for (int i = 0; i < r->thread_count && r->worker; i++) {
        free(r->worker[i].vector);
        free(r->worker[i].scratch);
        free(r->worker[i].known);
        weft_near_projector_free(&r->worker[i].near_projector);
    }
    free(r->worker);
}

static weft_code create_workers(run *r, const weft_dataset_layout *layout, weft_error *error)
{
    size_t images = (size_t)r->images->image_count, all = (size_t)r->images->dataset_image_count;
    r->worker = calloc((size_t)r->thread_count, sizeof *r->worker);
    for (int i = 0; i < r->thread_count && r->worker; i++) {
        worker *own = &r->worker[i];
        own->vector = aligned_alloc(ALIGNMENT, BATCH * r->images->length * sizeof *own->vector);
        own->scratch = malloc(4 * all * sizeof *own->scratch);
        own->known = malloc(BATCH * images);
        if (!own->vector || !own->scratch || !own->known)
            return weft_fail_memory(error, "projection", BATCH * r->images->length * sizeof *own->vector);
        if (!r->projector)
            WEFT_TRY(
                weft_near_projector_create(layout, r->components, r->maps, r->images, &own->near_projector, error));
    }
    return r->worker ? WEFT_OK : weft_fail_memory(error, "projection", (size_t)r->thread_count * sizeof *r->worker);
}

static weft_code collect(const run *r, weft_error *error)
{
    for (int i = 0; i < r->thread_count; i++) {
        worker *own = &r->worker[i];
        r->projection->masked += own->masked;
        r->projection->empty += own->empty;
        own->masked = own->empty = 0;
        if (own->code != WEFT_OK) {
            *error = own->error;
            return own->code;
        }
    }
    return WEFT_OK;
}

static weft_code project_blocks(run *r, weft_block_reader *reader, weft_thread_pool *pool, const weft_block_plan *plan,
                                size_t first, const weft_projection_job *job, weft_error *error)
{
    long total = (long)(plan->count - first);
    for (long i = 0; i < total; i++) {
        weft_progress_report(job->progress, "projecting on components", i, total);
        WEFT_TRY(weft_block_reader_next(reader, &r->block, error));
        long texels = (long)r->block->place.width * r->block->place.height;
        weft_thread_pool_run(pool, project_batch, r, (texels + BATCH - 1) / BATCH);
        WEFT_TRY(collect(r, error));
        WEFT_TRY(keep_block(job->checkpoint, r->projection, &r->block->place, error));
    }
    weft_progress_report(job->progress, "projecting on components", total, total);
    return WEFT_OK;
}

static int side_level_for(const weft_dataset_layout *layout)
{
    int level = 0;
    while (level < MOST_SIDE_LEVEL && weft_block_reader_bytes(layout, (size_t)4 << (2 * level)) <= 2 * BLOCK_BYTES)
        level++;
    return level;
}

static weft_code allocate(const weft_dataset_layout *layout, int component_count, weft_projection *projection,
                          weft_error *error)
{
    size_t texels = (size_t)layout->width * (size_t)layout->height;
    *projection =
        (weft_projection){.width = layout->width, .height = layout->height, .component_count = component_count};
    projection->coefficient = malloc(texels * (size_t)component_count * sizeof *projection->coefficient);
    projection->brightest = calloc(texels, sizeof *projection->brightest);
    projection->floor = calloc(3 * texels, sizeof *projection->floor);
    if (projection->coefficient && projection->brightest && projection->floor)
        return WEFT_OK;
    weft_projection_free(projection);
    return weft_fail_memory(error, "coefficients", texels * (size_t)component_count * sizeof(float));
}

static weft_code project(run *r, weft_dataset *dataset, const weft_block_plan *plan, size_t block_texels,
                         const weft_projection_job *job, weft_error *error)
{
    weft_block_reader *reader = NULL;
    weft_thread_pool *pool = NULL;
    size_t first;
    WEFT_TRY(take_kept_blocks(job->checkpoint, job->log, plan, r->projection, &first, error));
    WEFT_TRY(weft_block_reader_create(dataset, plan->place + first, plan->count - first, block_texels, &reader, error));
    weft_code code = weft_thread_pool_create(r->thread_count, &pool, error);
    if (code == WEFT_OK)
        code = create_workers(r, weft_dataset_get_layout(dataset), error);
    if (code == WEFT_OK)
        code = project_blocks(r, reader, pool, plan, first, job, error);
    free_workers(r);
    weft_thread_pool_free(pool);
    weft_block_reader_free(reader);
    return code;
}

weft_code weft_projection_make(weft_dataset *dataset, const weft_component_images *images,
                               const weft_projector *projector, const weft_factorisation *components,
                               const weft_component_maps *maps, const weft_projection_job *job,
                               weft_projection *projection, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    int side_level = side_level_for(layout);
    size_t block_texels = (size_t)1 << (2 * side_level);
    uint64_t texels = (uint64_t)layout->width * (uint64_t)layout->height;
    run r = {.images = images,
             .projector = projector,
             .components = components,
             .maps = maps,
             .projection = projection,
             .thread_count = omp_get_max_threads()};
    weft_block_plan plan;
    WEFT_TRY(weft_memory_budget_require(job->budget,
                                        weft_block_reader_bytes(layout, block_texels) +
                                            (texels + 3 * block_texels) * 4 * (uint64_t)(components->count + 4) +
                                            (uint64_t)r.thread_count * (uint64_t)layout->image_count *
                                                (32 * BATCH + (projector ? 0 : 12 * (uint64_t)components->count + 128)),
                                        weft_dataset_path(dataset), "its components", error));
    WEFT_TRY(allocate(layout, components->count, projection, error));
    weft_code code = weft_block_plan_create(layout->width, layout->height, side_level, 0, &plan, error);
    if (code == WEFT_OK) {
        code = project(&r, dataset, &plan, block_texels, job, error);
        weft_block_plan_free(&plan);
    }
    if (code != WEFT_OK)
        weft_projection_free(projection);
    return code;
}
