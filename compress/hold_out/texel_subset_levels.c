#include "compress/hold_out/texel_subset.h"

#include "base/integers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LARGEST_SIDE = 1 << WEFT_TEXEL_SUBSET_LAST_LEVEL, FEWEST = 4, RUN = 64 };

/* ---- Which texels ---- */

/* Of a level: texel (x, y) of the dataset and those beside it, `side` along each side. */
typedef struct level_texel {
    int x, y, side, level;
} level_texel;

/* In the order of the subset. */
typedef struct level_texels {
    int columns, rows, count;
    level_texel *texel; /* [columns x rows] */
} level_texels;

static int texels_along(int size, int level, int most)
{
    return weft_smaller(most, size >> level);
}

static void add_level(const weft_dataset_layout *layout, int level, int most, level_texels *all)
{
    int width = layout->width >> level, height = layout->height >> level, side = 1 << level;
    int columns = texels_along(layout->width, level, most), rows = texels_along(layout->height, level, most);
    if (columns * rows < FEWEST)
        return;
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++) {
            int x, y;
            weft_scattered_texel(columns, rows, width, height, i, j, &x, &y);
            all->texel[all->count++] = (level_texel){side * x, side * y, side, level};
        }
}

/* The last row is filled up with its last texel. */
static weft_code choose_texels(const weft_dataset_layout *layout, int side, level_texels *all, weft_error *error)
{
    int columns = side > 0 ? texels_along(layout->width, 0, side) : WEFT_TEXEL_SUBSET_LEVEL_SIDE;
    size_t most = (size_t)side * (size_t)side +
                  WEFT_TEXEL_SUBSET_LAST_LEVEL * WEFT_TEXEL_SUBSET_LEVEL_SIDE * WEFT_TEXEL_SUBSET_LEVEL_SIDE +
                  (size_t)columns;
    *all = (level_texels){.columns = columns, .texel = calloc(most, sizeof *all->texel)};
    if (!all->texel)
        return weft_fail_memory(error, "texels", most * sizeof *all->texel);
    if (side > 0)
        add_level(layout, 0, side, all);
    for (int level = 1; level <= WEFT_TEXEL_SUBSET_LAST_LEVEL; level++)
        add_level(layout, level, WEFT_TEXEL_SUBSET_LEVEL_SIDE, all);
    while (all->count % columns > 0) {
        all->texel[all->count] = all->texel[all->count - 1];
        all->texel[all->count++].level = WEFT_TEXEL_SUBSET_NO_LEVEL;
    }
    all->rows = all->count / columns;
    return WEFT_OK;
}

/* ---- Means ---- */

/* Images first .. end - 1 of all texels, texel by texel, as they lie in memory. */
static void average_run(const weft_half *samples, const uint8_t *mask, size_t texels, size_t images, size_t first,
                        size_t end, weft_half *mean, uint8_t *mean_mask)
{
    double sum[RUN][3] = {{0}};
    int count[RUN] = {0};
    for (size_t texel = 0; texel < texels; texel++)
        for (size_t image = first; image < end; image++) {
            size_t at = texel * images + image;
            for (size_t c = 0; c < 3 && !mask[at]; c++)
                sum[image - first][c] += (double)weft_float_of_half(samples[3 * at + c]);
            count[image - first] += !mask[at];
        }
    for (size_t image = first; image < end; image++) {
        mean_mask[image] = count[image - first] == 0;
        for (size_t c = 0; c < 3; c++)
            mean[3 * image + c] =
                weft_half_of_float((float)(sum[image - first][c] / weft_larger(1, count[image - first])));
    }
}

static void average_samples(const weft_half *samples, const uint8_t *mask, size_t texels, size_t images,
                            weft_half *mean, uint8_t *mean_mask)
{
#pragma omp parallel for
    for (size_t first = 0; first < images; first += RUN)
        average_run(samples, mask, texels, images, first, first + RUN < images ? first + RUN : images, mean, mean_mask);
}

static weft_code read_samples(weft_dataset *dataset, const level_texels *all, weft_texel_subset *subset,
                              weft_error *error)
{
    size_t images = (size_t)subset->layout.image_count, count = (size_t)all->count,
           block = LARGEST_SIDE * LARGEST_SIDE * images;
    weft_half *samples = malloc(3 * block * sizeof *samples);
    uint8_t *mask = malloc(block);
    subset->samples = malloc(3 * count * images * sizeof *subset->samples);
    subset->mask = malloc(count * images);
    bool has_memory = samples && mask && subset->samples && subset->mask;
    weft_code code = has_memory ? WEFT_OK : weft_fail_memory(error, "samples", 7 * (count * images + block));
    for (size_t i = 0; code == WEFT_OK && i < count; i++) {
        const level_texel *texel = &all->texel[i];
        code = weft_dataset_read_block(dataset, texel->x, texel->y, texel->side, texel->side, samples, mask, error);
        if (code == WEFT_OK)
            average_samples(samples, mask, (size_t)texel->side * (size_t)texel->side, images,
                            subset->samples + 3 * i * images, subset->mask + i * images);
    }
    free(samples);
    free(mask);
    return code;
}

typedef weft_code read_rows(weft_dataset *dataset, int y, int height, float *values, weft_error *error);

static void average_numbers(const float *rows, size_t width, const level_texel *texel, size_t each, float *mean)
{
    int count = texel->side * texel->side;
    for (size_t k = 0; k < each; k++) {
        double sum = 0;
        for (int i = 0; i < count; i++) {
            size_t at = (size_t)(i / texel->side) * width + (size_t)(texel->x + i % texel->side);
            sum += (double)rows[at * each + k];
        }
        mean[k] = (float)(sum / count);
    }
}

/* What a dataset keeps beside its samples: means of `each` numbers a texel. */
static weft_code read_numbers(weft_dataset *dataset, const level_texels *all, read_rows *read, size_t each,
                              float **numbers, weft_error *error)
{
    size_t width = (size_t)weft_dataset_get_layout(dataset)->width;
    float *rows = malloc(LARGEST_SIDE * width * each * sizeof *rows);
    *numbers = malloc((size_t)all->count * each * sizeof **numbers);
    weft_code code = rows && *numbers ? WEFT_OK : weft_fail_memory(error, "rows", width * each * sizeof *rows);
    for (int i = 0; code == WEFT_OK && i < all->count; i++) {
        code = read(dataset, all->texel[i].y, all->texel[i].side, rows, error);
        if (code == WEFT_OK)
            average_numbers(rows, width, &all->texel[i], each, *numbers + (size_t)i * each);
    }
    free(rows);
    return code;
}

/* Means of unit normals and of tangents perpendicular to them become such again. */
static void straighten(float *frames, int count)
{
    for (int i = 0; i < count; i++) {
        float *f = frames + 6 * (size_t)i;
        weft_vec3 normal = weft_unit(weft_vec3_of((weft_real)f[0], (weft_real)f[1], (weft_real)f[2])),
                  tangent = weft_vec3_of((weft_real)f[3], (weft_real)f[4], (weft_real)f[5]);
        weft_vec3 along = weft_scale(normal, weft_dot(normal, tangent));
        tangent = weft_unit(weft_subtract(tangent, along));
        const float straight[6] = {(float)normal.x,  (float)normal.y,  (float)normal.z,
                                   (float)tangent.x, (float)tangent.y, (float)tangent.z};
        memcpy(f, straight, sizeof straight);
    }
}

/* ---- The whole ---- */

static weft_code read_all(weft_dataset *dataset, const level_texels *all, weft_texel_subset *subset, uint8_t **level,
                          weft_error *error)
{
    const weft_dataset_layout *source = weft_dataset_get_layout(dataset);
    *level = malloc((size_t)all->count);
    if (!*level)
        return weft_fail_memory(error, "texels", (size_t)all->count);
    for (int i = 0; i < all->count; i++)
        (*level)[i] = (uint8_t)all->texel[i].level;
    WEFT_TRY(weft_texel_subset_make_layout(source, all->columns, all->rows, 1, weft_vec3_of(0, 0, 0), &subset->layout,
                                           error));
    WEFT_TRY(read_samples(dataset, all, subset, error));
    if (weft_dataset_has_opacity(dataset))
        WEFT_TRY(
            read_numbers(dataset, all, weft_dataset_read_opacity, (size_t)source->view_count, &subset->opacity, error));
    if (!weft_dataset_has_frames(dataset))
        return WEFT_OK;
    WEFT_TRY(read_numbers(dataset, all, weft_dataset_read_frames, 6, &subset->frames, error));
    straighten(subset->frames, all->count);
    return WEFT_OK;
}

weft_code weft_texel_subset_read_levels(weft_dataset *dataset, int side, weft_texel_subset *subset, uint8_t **level,
                                        weft_error *error)
{
    const weft_dataset_layout *source = weft_dataset_get_layout(dataset);
    level_texels all;
    *level = NULL;
    *subset = (weft_texel_subset){.window = {0, 0, source->width, source->height}, .neighbours = 1};
    weft_dataset_size_mm(source, subset->whole_mm);
    weft_code code = choose_texels(source, side, &all, error);
    if (code == WEFT_OK)
        code = read_all(dataset, &all, subset, level, error);
    free(all.texel);
    return code;
}
