#include "compress/components/training.h"

#include "btf/material/components.h"

#include <stdlib.h>
#include <string.h>

enum { SQUARE = 8, ALIGNMENT = 64 };

void weft_training_free(weft_training *training)
{
    free(training->place);
    free(training->vector);
    free(training->known);
    *training = (weft_training){0};
}

weft_code weft_training_allocate(int texels, size_t length, size_t image_count, weft_training *training,
                                 weft_error *error)
{
    size_t count = (size_t)texels;
    *training = (weft_training){.texel_count = texels, .length = length, .image_count = image_count};
    training->place = calloc(count, sizeof *training->place);
    training->vector = aligned_alloc(ALIGNMENT, count * length * sizeof *training->vector);
    training->known = malloc(count * image_count);
    if (!training->place || !training->vector || !training->known) {
        weft_training_free(training);
        return weft_fail_memory(error, "samples to learn components from", count * length * sizeof(float));
    }
    memset(training->vector, 0, count * length * sizeof *training->vector);
    memset(training->known, WEFT_SAMPLE_VALID, count * image_count);
    return WEFT_OK;
}

/* ---- Which texels ---- */

/* Squares along a side of the material: all where there are few, else eight. */
static int squares_along(int size)
{
    int all = (size + SQUARE - 1) / SQUARE;
    return all < SQUARE ? all : SQUARE;
}

/* The first texel of square `index` of `count` that are spread over `size` texels. */
static int square_at(int index, int count, int size)
{
    int room = size > SQUARE ? size - SQUARE : 0;
    return count > 1 ? (int)((long)room * index / (count - 1)) : room / 2;
}

static int extent(int size)
{
    return size < SQUARE ? size : SQUARE;
}

/* Of the texels of all squares, one in so many is taken: in an even pattern, shifted from row to row. */
static int stride_of(const weft_dataset_layout *layout)
{
    int texels = squares_along(layout->width) * squares_along(layout->height) * SQUARE * SQUARE;
    return (texels + WEFT_TRAINING_TEXELS - 1) / WEFT_TRAINING_TEXELS;
}

/* ---- Reading ---- */

typedef struct reading {
    weft_dataset *dataset;
    const weft_component_images *images;
    weft_training *training;
    weft_half *samples; /* of a square */
    uint8_t *mask;
    float *scratch;
    int least; /* valid images that a texel must have */
} reading;

static void take_texel(reading *r, int x, int y, size_t at)
{
    weft_training *t = r->training;
    size_t all = (size_t)r->images->dataset_image_count, index = (size_t)t->texel_count;
    int valid = weft_component_images_gather(r->images, r->samples + 3 * all * at, r->mask + all * at, r->scratch,
                                             t->vector + index * t->length, t->known + index * t->image_count);
    if (valid < r->least)
        return;
    t->place[t->texel_count++] = (weft_training_place){x, y};
}

static weft_code read_square(reading *r, int x0, int y0, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(r->dataset);
    int width = extent(layout->width), height = extent(layout->height);
    WEFT_TRY(weft_dataset_read_block(r->dataset, x0, y0, width, height, r->samples, r->mask, error));
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            if ((x + 3 * y) % stride_of(layout) == 0 && r->training->texel_count < WEFT_TRAINING_TEXELS)
                take_texel(r, x0 + x, y0 + y, (size_t)y * (size_t)width + (size_t)x);
        }
    return WEFT_OK;
}

static weft_code read_squares(reading *r, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(r->dataset);
    int columns = squares_along(layout->width), rows = squares_along(layout->height);
    r->training->texel_count = 0;
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++)
            WEFT_TRY(read_square(r, square_at(i, columns, layout->width), square_at(j, rows, layout->height), error));
    return WEFT_OK;
}

/* Texels with few images teach little, but are better than none. */
static weft_code read_any(reading *r, weft_error *error)
{
    r->least = (r->images->image_count + 1) / 2;
    WEFT_TRY(read_squares(r, error));
    if (r->training->texel_count > 0)
        return WEFT_OK;
    r->least = 1;
    WEFT_TRY(read_squares(r, error));
    return r->training->texel_count > 0 ? WEFT_OK
                                        : weft_fail(error, WEFT_BAD_INPUT, "'%s' holds no valid sample to learn from",
                                                    weft_dataset_path(r->dataset));
}

weft_code weft_training_read(weft_dataset *dataset, const weft_component_images *images, weft_training *training,
                             weft_error *error)
{
    size_t square = SQUARE * SQUARE, all = (size_t)images->dataset_image_count;
    reading r = {.dataset = dataset,
                 .images = images,
                 .training = training,
                 .samples = malloc(square * all * 3 * sizeof *r.samples),
                 .mask = malloc(square * all),
                 .scratch = malloc(4 * all * sizeof *r.scratch)};
    weft_code code = r.samples && r.mask && r.scratch ? WEFT_OK : weft_fail_memory(error, "samples", square * all * 7);
    *training = (weft_training){0};
    if (code == WEFT_OK)
        code =
            weft_training_allocate(WEFT_TRAINING_TEXELS, images->length, (size_t)images->image_count, training, error);
    if (code == WEFT_OK)
        code = read_any(&r, error);
    if (code != WEFT_OK)
        weft_training_free(training);
    free(r.samples);
    free(r.mask);
    free(r.scratch);
    return code;
}

/* ---- Coded values ---- */

void weft_training_code(weft_training *training, const weft_component_images *images, float exponent)
{
#pragma omp parallel for schedule(static)
    for (int texel = 0; texel < training->texel_count; texel++) {
        float *vector = training->vector + (size_t)texel * training->length;
        for (size_t i = 0; i < 3 * training->image_count; i++)
            vector[i] = images->weight[i / 3] * weft_coded(exponent, vector[i] / images->weight[i / 3]);
    }
}

/* ---- Some of the texels, or of the images ---- */

weft_code weft_training_thin(const weft_training *whole, int most, weft_training *subset, weft_error *error)
{
    int count = whole->texel_count < most ? whole->texel_count : most;
    WEFT_TRY(weft_training_allocate(count, whole->length, whole->image_count, subset, error));
    for (size_t i = 0; i < (size_t)count; i++) {
        size_t from = i * (size_t)whole->texel_count / (size_t)count;
        subset->place[i] = whole->place[from];
        memcpy(subset->vector + i * whole->length, whole->vector + from * whole->length,
               whole->length * sizeof *whole->vector);
        memcpy(subset->known + i * whole->image_count, whole->known + from * whole->image_count, whole->image_count);
    }
    return WEFT_OK;
}

weft_code weft_training_subset(const weft_training *whole, const weft_component_images *images, const int *choice,
                               weft_training *subset, weft_error *error)
{
    size_t count = (size_t)images->image_count;
    WEFT_TRY(weft_training_allocate(whole->texel_count, images->length, count, subset, error));
    memcpy(subset->place, whole->place, (size_t)whole->texel_count * sizeof *whole->place);
    for (size_t texel = 0; texel < (size_t)whole->texel_count; texel++)
        for (size_t i = 0; i < count; i++) {
            size_t from = (size_t)choice[i];
            subset->known[texel * count + i] = whole->known[texel * whole->image_count + from];
            memcpy(subset->vector + texel * images->length + 3 * i, whole->vector + texel * whole->length + 3 * from,
                   3 * sizeof *subset->vector);
        }
    return WEFT_OK;
}

/* ---- What is masked ---- */

bool weft_training_is_whole(const weft_training *training)
{
    size_t entries = (size_t)training->texel_count * training->image_count;
    bool is = true;
    for (size_t i = 0; i < entries; i++)
        is = is && training->known[i] == WEFT_SAMPLE_VALID;
    return is;
}

weft_code weft_training_fill_by_mean(weft_training *training, weft_error *error)
{
    size_t images = training->image_count, length = training->length;
    double *mean = calloc(3 * images, sizeof *mean);
    if (!mean)
        return weft_fail_memory(error, "mean texel", 3 * images * sizeof *mean);
    for (size_t i = 0; i < images; i++) {
        double count = 0;
        for (size_t texel = 0; texel < (size_t)training->texel_count; texel++)
            count += training->known[texel * images + i] != 0;
        for (size_t texel = 0; texel < (size_t)training->texel_count && count > 0; texel++)
            for (size_t c = 0; c < 3; c++)
                mean[3 * i + c] += (double)training->vector[texel * length + 3 * i + c] / count;
    }
    for (size_t texel = 0; texel < (size_t)training->texel_count; texel++) {
        float *vector = training->vector + texel * length;
        const uint8_t *known = training->known + texel * images;
        double own = 0, others = 1e-30;
        for (size_t i = 0; i < 3 * images; i++) {
            own += known[i / 3] ? (double)vector[i] : 0;
            others += known[i / 3] ? mean[i] : 0;
        }
        for (size_t i = 0; i < 3 * images; i++) {
            if (!known[i / 3])
                vector[i] = (float)(mean[i] * own / others);
        }
    }
    free(mean);
    return WEFT_OK;
}

void weft_training_drop_clipped(weft_training *training)
{
    for (size_t texel = 0; texel < (size_t)training->texel_count; texel++)
        for (size_t i = 0; i < training->image_count; i++) {
            uint8_t *known = &training->known[texel * training->image_count + i];
            if (*known == WEFT_SAMPLE_VALID)
                continue;
            *known = 0;
            memset(training->vector + texel * training->length + 3 * i, 0, 3 * sizeof *training->vector);
        }
}
