#include "btf/dataset/read_blocks.h"
#include "btf/dataset/write_blocks.h"
#include "edit/tile/search_steps.h"
#include "edit/tile/tile.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Bytes of the rows of the tile that are in memory, about. */
static const size_t enough_bytes = (size_t)1 << 30;

/* Of one image, for the residual: sums over its valid samples. */
typedef struct image_sums {
    double weight, sum, squares; /* grey, over the rows of the tile done so far */
    double explained;            /* weight times squared mean, summed over the texels of the tile */
} image_sums;

typedef struct tile_average {
    const weft_dataset_layout *layout; /* of the material */
    weft_dataset_layout tile_layout;   /* shares the arrays of `layout` */
    weft_tile tile;
    int first, rows;    /* rows of the tile in memory */
    float *sum;         /* [rows][columns][image_count][3] */
    float *weight;      /* [rows][columns][image_count] */
    image_sums *image;  /* [image_count] */
    weft_half *samples; /* [rows][columns][image_count][3] */
    uint8_t *mask;      /* [rows][columns][image_count] */
    weft_tile_report *report;
} tile_average;

/* ---- A block of the material into the rows of the tile in memory ---- */

/* Where a texel goes: rows that are not in memory have no weight. */
typedef struct target {
    size_t texel[4];
    float weight[4];
} target;

static target target_of(const tile_average *average, int x, int y)
{
    weft_tile_place u =
        weft_tile_place_of(x + 0.5, average->tile.left, average->tile.width, average->tile_layout.width);
    weft_tile_place v =
        weft_tile_place_of(y + 0.5, average->tile.top, average->tile.height, average->tile_layout.height);
    target result;
    for (int i = 0; i < 4; i++) {
        int column = i & 1 ? u.high : u.low, row = (i & 2 ? v.high : v.low) - average->first;
        double weight = (i & 1 ? u.share : 1 - u.share) * (i & 2 ? v.share : 1 - v.share);
        bool in_memory = row >= 0 && row < average->rows;
        result.texel[i] = in_memory ? (size_t)row * (size_t)average->tile_layout.width + (size_t)column : 0;
        result.weight[i] = in_memory ? (float)weight : 0;
    }
    return result;
}

static void add_sample(const tile_average *average, const target *to, size_t image, const weft_half *half)
{
    size_t images = (size_t)average->layout->image_count;
    image_sums *sums = &average->image[image];
    float rgb[3] = {weft_float_of_half(half[0]), weft_float_of_half(half[1]), weft_float_of_half(half[2])};
    double grey = ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3;
    for (int i = 0; i < 4; i++) {
        float weight = to->weight[i];
        size_t at = to->texel[i] * images + image;
        if (!(weight > 0))
            continue;
        average->sum[3 * at] += weight * rgb[0];
        average->sum[3 * at + 1] += weight * rgb[1];
        average->sum[3 * at + 2] += weight * rgb[2];
        average->weight[at] += weight;
        sums->weight += (double)weight;
        sums->sum += (double)weight * grey;
        sums->squares += (double)weight * grey * grey;
    }
}

/* Threads share the images, so that none waits for another. */
static void add_block(void *context, const weft_walk_block *block)
{
    enum { TOGETHER = 128 };
    const tile_average *average = context;
    int images = average->layout->image_count;
#pragma omp parallel for schedule(static)
    for (int first = 0; first < images; first += TOGETHER) {
        int end = first + TOGETHER < images ? first + TOGETHER : images;
        for (int i = 0; i < block->width * block->height; i++) {
            target to = target_of(average, block->x + i % block->width, block->y + i / block->width);
            size_t sample = (size_t)i * (size_t)images;
            for (int image = first; image < end; image++)
                if (!block->mask[sample + (size_t)image])
                    add_sample(average, &to, (size_t)image, block->samples + 3 * (sample + (size_t)image));
        }
    }
}

/* ---- The rows of the tile ---- */

static void finish_sample(const tile_average *average, size_t at, image_sums *sums, long *empty)
{
    float weight = average->weight[at];
    average->mask[at] = weight > 0 ? 0 : WEFT_MASK_MISSING;
    *empty += !(weight > 0);
    double grey = 0;
    for (size_t c = 0; c < 3; c++) {
        float mean = weight > 0 ? average->sum[3 * at + c] / weight : 0;
        average->samples[3 * at + c] = weft_half_of_float(mean);
        grey += (double)mean / 3;
    }
    sums->explained += (double)weight * grey * grey;
}

static weft_code average_rows(tile_average *average, weft_dataset *dataset, weft_dataset_block_writer *writer,
                              const weft_progress *progress, weft_error *error)
{
    size_t images = (size_t)average->layout->image_count,
           texels = (size_t)average->rows * (size_t)average->tile_layout.width;
    memset(average->sum, 0, 3 * texels * images * sizeof *average->sum);
    memset(average->weight, 0, texels * images * sizeof *average->weight);
    WEFT_TRY(weft_walk_blocks(dataset, add_block, average, "averaging tiles", progress, error));
    for (size_t at = 0; at < texels * images; at++)
        finish_sample(average, at, &average->image[at % images], &average->report->empty_count);
    return weft_dataset_block_writer_put(writer, 0, average->first, average->tile_layout.width, average->rows,
                                         average->samples, average->mask, error);
}

/* ---- The whole ---- */

/* Every image counts relative to its mean. */
static void sum_residual(const tile_average *average)
{
    double residual = 0, variance = 0, weight = 0;
    for (int i = 0; i < average->layout->image_count; i++) {
        const image_sums *sums = &average->image[i];
        double mean = sums->weight > 0 ? sums->sum / sums->weight : 0;
        if (!(mean > 0))
            continue;
        residual += fmax(sums->squares - sums->explained, 0) / (mean * mean);
        variance += (sums->squares - sums->weight * mean * mean) / (mean * mean);
        weight += sums->weight;
    }
    average->report->residual_share = variance > 0 ? residual / variance : 0;
    average->report->residual_relative = weight > 0 ? sqrt(residual / weight) : 0;
}

static weft_code write_rows(tile_average *average, weft_dataset *dataset, weft_dataset_block_writer *writer,
                            int most_rows, const weft_progress *progress, weft_error *error)
{
    for (average->first = 0; average->first < average->tile_layout.height; average->first += average->rows) {
        int left = average->tile_layout.height - average->first;
        average->rows = left < most_rows ? left : most_rows;
        WEFT_TRY(average_rows(average, dataset, writer, progress, error));
    }
    sum_residual(average);
    return WEFT_OK;
}

/* Opacity of the mean tile, [height][width][view_count], from that of the material. */
static weft_code average_opacity(const tile_average *average, weft_dataset *dataset, float *row, float *mean,
                                 float *weight, bool *has_holes, weft_error *error)
{
    const weft_dataset_layout *layout = average->layout;
    size_t views = (size_t)layout->view_count;
    for (int y = 0; y < layout->height; y++) {
        WEFT_TRY(weft_dataset_read_opacity(dataset, y, 1, row, error));
        for (int x = 0; x < layout->width; x++) {
            target to = target_of(average, x, y);
            for (int i = 0; i < 4; i++) {
                weight[to.texel[i]] += to.weight[i];
                for (size_t v = 0; v < views; v++)
                    mean[to.texel[i] * views + v] += to.weight[i] * row[(size_t)x * views + v];
            }
        }
        for (size_t i = 0; i < (size_t)layout->width * views; i++)
            *has_holes |= row[i] < 1;
    }
    size_t values = (size_t)average->tile_layout.width * (size_t)average->tile_layout.height * views;
    for (size_t i = 0; i < values; i++)
        mean[i] = weight[i / views] > 0 ? fminf(mean[i] / weight[i / views], 1) : 1;
    return WEFT_OK;
}

static weft_code write_opacity(tile_average *average, weft_dataset *dataset, weft_dataset_block_writer *writer,
                               weft_error *error)
{
    size_t texels = (size_t)average->tile_layout.width * (size_t)average->tile_layout.height;
    size_t views = (size_t)average->layout->view_count;
    bool has_holes = false;
    float *row = malloc((size_t)average->layout->width * views * sizeof *row);
    float *mean = calloc(texels * views, sizeof *mean), *weight = calloc(texels, sizeof *weight);
    weft_code code = WEFT_OK;
    average->first = 0;
    average->rows = average->tile_layout.height;
    if (!row || !mean || !weight)
        code = weft_fail_memory(error, "opacity", texels * views * sizeof *mean);
    if (code == WEFT_OK)
        code = average_opacity(average, dataset, row, mean, weight, &has_holes, error);
    if (code == WEFT_OK && has_holes)
        code = weft_dataset_block_writer_put_opacity(writer, mean, error);
    free(row);
    free(mean);
    free(weight);
    return code;
}

static weft_code finish(const tile_average *average, weft_dataset_block_writer *writer, weft_error *error)
{
    const weft_tile_report *report = average->report;
    const weft_tile *tile = &report->tile;
    json_t *made = json_pack("{s[ff] s[ff] s[ff] s[ff] sf}", "size_mm", report->width_mm, report->height_mm,
                             "size_texels", tile->width, tile->height, "corner_texels", tile->left, tile->top, "tiles",
                             report->tiles_x, report->tiles_y, "residual_share", report->residual_share);
    return weft_derived_dataset_finish(writer, average->layout, "tile", made, error);
}

static weft_code write_tile(tile_average *average, weft_dataset *dataset, const char *output, int most_rows,
                            const weft_progress *progress, weft_error *error)
{
    weft_dataset_block_writer *writer;
    WEFT_TRY(weft_dataset_block_writer_create(output, &average->tile_layout, &writer, error));
    weft_code code = write_rows(average, dataset, writer, most_rows, progress, error);
    if (code == WEFT_OK)
        code = write_opacity(average, dataset, writer, error);
    if (code == WEFT_OK)
        return finish(average, writer, error);
    weft_dataset_block_writer_abandon(writer);
    return code;
}

/* Square texels, as near as whole numbers of them allow. */
static void lay_out(tile_average *average)
{
    const weft_tile *tile = &average->tile;
    average->tile_layout = *average->layout;
    average->tile_layout.width = (int)lround(tile->width);
    average->tile_layout.height = (int)lround(tile->height);
    double area = tile->width * tile->height / ((double)average->tile_layout.width * average->tile_layout.height);
    average->tile_layout.texel_pitch_mm = average->layout->texel_pitch_mm * sqrt(area);
    average->tile_layout.texel_aspect = weft_dataset_texel_aspect(average->layout) * (tile->width / tile->height) *
                                        average->tile_layout.height / average->tile_layout.width;
    average->report->texels_x = average->tile_layout.width;
    average->report->texels_y = average->tile_layout.height;
}

weft_code weft_tile_write(weft_dataset *dataset, const char *output, const weft_progress *progress,
                          weft_tile_report *report, weft_error *error)
{
    tile_average average = {.layout = weft_dataset_get_layout(dataset), .tile = report->tile, .report = report};
    WEFT_TRY(weft_derived_dataset_check(dataset, output, "the tile would replace it", error));
    lay_out(&average);
    report->empty_count = 0;
    size_t images = (size_t)average.layout->image_count, row = (size_t)average.tile_layout.width * images;
    size_t sample_bytes = 4 * sizeof *average.sum + 3 * sizeof *average.samples + sizeof *average.mask;
    size_t fit = enough_bytes / (row * sample_bytes);
    int most_rows = fit < 1 ? 1 : fit < (size_t)average.tile_layout.height ? (int)fit : average.tile_layout.height;
    size_t samples = row * (size_t)most_rows;
    average.sum = malloc(3 * samples * sizeof *average.sum);
    average.weight = malloc(samples * sizeof *average.weight);
    average.samples = malloc(3 * samples * sizeof *average.samples);
    average.mask = malloc(samples);
    average.image = calloc(images, sizeof *average.image);
    weft_code code = WEFT_OK;
    if (!average.sum || !average.weight || !average.samples || !average.mask || !average.image)
        code = weft_fail_memory(error, "rows of the tile", samples * sample_bytes);
    if (code == WEFT_OK)
        code = write_tile(&average, dataset, output, most_rows, progress, error);
    free(average.sum);
    free(average.weight);
    free(average.samples);
    free(average.mask);
    free(average.image);
    return code;
}
