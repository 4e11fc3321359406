#include "study/block_walk.h"
#include "study/tile.h"
#include "study/tile_mean.h"

#include "btf/dataset_blocks.h"
#include "btf/json_text.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Bytes of the rows of the tile that are in memory, about. */
static const size_t enough_bytes = (size_t)1 << 30;

/* Of one image, for the residual: sums over its valid samples. */
typedef struct image_sums {
    double weight, sum, squares; /* grey, over the rows of the tile done so far */
    double explained;            /* weight times squared mean, summed over the texels of the tile */
} image_sums;

typedef struct averaging {
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
} averaging;

/* ---- A block of the material into the rows of the tile in memory ---- */

/* Where a texel goes: rows that are not in memory have no weight. */
typedef struct target {
    size_t texel[4];
    float weight[4];
} target;

static target target_of(const averaging *of, int x, int y)
{
    weft_tile_place u = weft_tile_place_of(x + 0.5, of->tile.left, of->tile.width, of->tile_layout.width);
    weft_tile_place v = weft_tile_place_of(y + 0.5, of->tile.top, of->tile.height, of->tile_layout.height);
    target result;
    for (int i = 0; i < 4; i++) {
        int column = i & 1 ? u.high : u.low, row = (i & 2 ? v.high : v.low) - of->first;
        double weight = (i & 1 ? u.share : 1 - u.share) * (i & 2 ? v.share : 1 - v.share);
        bool in_memory = row >= 0 && row < of->rows;
        result.texel[i] = in_memory ? (size_t)row * (size_t)of->tile_layout.width + (size_t)column : 0;
        result.weight[i] = in_memory ? (float)weight : 0;
    }
    return result;
}

static void add_sample(const averaging *of, const target *to, size_t image, const weft_half *half)
{
    size_t images = (size_t)of->layout->image_count;
    image_sums *sums = &of->image[image];
    float rgb[3] = {weft_float_of_half(half[0]), weft_float_of_half(half[1]), weft_float_of_half(half[2])};
    double grey = ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3;
    for (int i = 0; i < 4; i++) {
        float weight = to->weight[i];
        size_t at = to->texel[i] * images + image;
        if (!(weight > 0))
            continue;
        of->sum[3 * at] += weight * rgb[0];
        of->sum[3 * at + 1] += weight * rgb[1];
        of->sum[3 * at + 2] += weight * rgb[2];
        of->weight[at] += weight;
        sums->weight += (double)weight;
        sums->sum += (double)weight * grey;
        sums->squares += (double)weight * grey * grey;
    }
}

/* Threads share the images, so that none waits for another. */
static void add_block(void *context, const weft_walk_block *block)
{
    enum { TOGETHER = 128 };
    const averaging *of = context;
    int images = of->layout->image_count;
#pragma omp parallel for schedule(static)
    for (int first = 0; first < images; first += TOGETHER) {
        int end = first + TOGETHER < images ? first + TOGETHER : images;
        for (int i = 0; i < block->width * block->height; i++) {
            target to = target_of(of, block->x + i % block->width, block->y + i / block->width);
            size_t sample = (size_t)i * (size_t)images;
            for (int image = first; image < end; image++)
                if (!block->mask[sample + (size_t)image])
                    add_sample(of, &to, (size_t)image, block->samples + 3 * (sample + (size_t)image));
        }
    }
}

/* ---- The rows of the tile ---- */

static void finish_sample(const averaging *of, size_t at, image_sums *sums, long *empty)
{
    float weight = of->weight[at];
    of->mask[at] = weight > 0 ? 0 : WEFT_MASK_MISSING;
    *empty += !(weight > 0);
    double grey = 0;
    for (size_t c = 0; c < 3; c++) {
        float mean = weight > 0 ? of->sum[3 * at + c] / weight : 0;
        of->samples[3 * at + c] = weft_half_of_float(mean);
        grey += (double)mean / 3;
    }
    sums->explained += (double)weight * grey * grey;
}

static weft_code average_rows(averaging *of, weft_dataset *dataset, weft_dataset_block_writer *writer,
                              const weft_progress *progress, weft_error *error)
{
    size_t images = (size_t)of->layout->image_count, texels = (size_t)of->rows * (size_t)of->tile_layout.width;
    memset(of->sum, 0, 3 * texels * images * sizeof *of->sum);
    memset(of->weight, 0, texels * images * sizeof *of->weight);
    WEFT_TRY(weft_walk_blocks(dataset, add_block, of, "averaging tiles", progress, error));
    for (size_t at = 0; at < texels * images; at++)
        finish_sample(of, at, &of->image[at % images], &of->report->empty_count);
    return weft_dataset_block_writer_put(writer, 0, of->first, of->tile_layout.width, of->rows, of->samples, of->mask,
                                         error);
}

/* ---- The whole ---- */

/* Every image counts relative to its mean. */
static void sum_residual(const averaging *of)
{
    double residual = 0, variance = 0, weight = 0;
    for (int i = 0; i < of->layout->image_count; i++) {
        const image_sums *sums = &of->image[i];
        double mean = sums->weight > 0 ? sums->sum / sums->weight : 0;
        if (!(mean > 0))
            continue;
        residual += fmax(sums->squares - sums->explained, 0) / (mean * mean);
        variance += (sums->squares - sums->weight * mean * mean) / (mean * mean);
        weight += sums->weight;
    }
    of->report->residual_share = variance > 0 ? residual / variance : 0;
    of->report->residual_relative = weight > 0 ? sqrt(residual / weight) : 0;
}

static weft_code write_rows(averaging *of, weft_dataset *dataset, weft_dataset_block_writer *writer, int most_rows,
                            const weft_progress *progress, weft_error *error)
{
    for (of->first = 0; of->first < of->tile_layout.height; of->first += of->rows) {
        int left = of->tile_layout.height - of->first;
        of->rows = left < most_rows ? left : most_rows;
        WEFT_TRY(average_rows(of, dataset, writer, progress, error));
    }
    sum_residual(of);
    return WEFT_OK;
}

/* Opacity of the mean tile, [height][width][view_count], from that of the material. */
static weft_code average_opacity(const averaging *of, weft_dataset *dataset, float *row, float *mean, float *weight,
                                 bool *has_holes, weft_error *error)
{
    const weft_dataset_layout *layout = of->layout;
    size_t views = (size_t)layout->view_count;
    for (int y = 0; y < layout->height; y++) {
        WEFT_TRY(weft_dataset_read_opacity(dataset, y, 1, row, error));
        for (int x = 0; x < layout->width; x++) {
            target to = target_of(of, x, y);
            for (int i = 0; i < 4; i++) {
                weight[to.texel[i]] += to.weight[i];
                for (size_t v = 0; v < views; v++)
                    mean[to.texel[i] * views + v] += to.weight[i] * row[(size_t)x * views + v];
            }
        }
        for (size_t i = 0; i < (size_t)layout->width * views; i++)
            *has_holes |= row[i] < 1;
    }
    size_t values = (size_t)of->tile_layout.width * (size_t)of->tile_layout.height * views;
    for (size_t i = 0; i < values; i++)
        mean[i] = weight[i / views] > 0 ? fminf(mean[i] / weight[i / views], 1) : 1;
    return WEFT_OK;
}

static weft_code write_opacity(averaging *of, weft_dataset *dataset, weft_dataset_block_writer *writer,
                               weft_error *error)
{
    size_t texels = (size_t)of->tile_layout.width * (size_t)of->tile_layout.height;
    size_t views = (size_t)of->layout->view_count;
    bool has_holes = false;
    float *row = malloc((size_t)of->layout->width * views * sizeof *row);
    float *mean = calloc(texels * views, sizeof *mean), *weight = calloc(texels, sizeof *weight);
    weft_code code = WEFT_OK;
    of->first = 0;
    of->rows = of->tile_layout.height;
    if (!row || !mean || !weight)
        code = weft_fail_memory(error, "opacity", texels * views * sizeof *mean);
    if (code == WEFT_OK)
        code = average_opacity(of, dataset, row, mean, weight, &has_holes, error);
    if (code == WEFT_OK && has_holes)
        code = weft_dataset_block_writer_put_opacity(writer, mean, error);
    free(row);
    free(mean);
    free(weight);
    return code;
}

/* That of the dataset, and what was done to it. The caller frees it; NULL where memory is short. */
static char *provenance_of(const averaging *of)
{
    const weft_tile_report *report = of->report;
    const weft_tile *tile = &report->tile;
    json_t *provenance = json_loads(of->layout->provenance, 0, NULL);
    json_t *made = json_pack("{s[ff] s[ff] s[ff] s[ff] sf}", "size_mm", report->width_mm, report->height_mm,
                             "size_texels", tile->width, tile->height, "corner_texels", tile->left, tile->top, "tiles",
                             report->tiles_x, report->tiles_y, "residual_share", report->residual_share);
    weft_json_put(&provenance, "tile", made);
    char *text = provenance ? json_dumps(provenance, JSON_COMPACT) : NULL;
    json_decref(provenance);
    return text;
}

static weft_code finish(const averaging *of, weft_dataset_block_writer *writer, weft_error *error)
{
    char *provenance = provenance_of(of);
    if (!provenance) {
        weft_dataset_block_writer_abandon(writer);
        return weft_fail_memory(error, "provenance", 0);
    }
    weft_code code = weft_dataset_block_writer_finish(writer, provenance, error);
    free(provenance);
    return code;
}

static weft_code write_tile(averaging *of, weft_dataset *dataset, const char *output, int most_rows,
                            const weft_progress *progress, weft_error *error)
{
    weft_dataset_block_writer *writer;
    WEFT_TRY(weft_dataset_block_writer_create(output, &of->tile_layout, &writer, error));
    weft_code code = write_rows(of, dataset, writer, most_rows, progress, error);
    if (code == WEFT_OK)
        code = write_opacity(of, dataset, writer, error);
    if (code == WEFT_OK)
        return finish(of, writer, error);
    weft_dataset_block_writer_abandon(writer);
    return code;
}

/* Square texels, as near as whole numbers of them allow. */
static void lay_out(averaging *of)
{
    const weft_tile *tile = &of->tile;
    of->tile_layout = *of->layout;
    of->tile_layout.width = (int)lround(tile->width);
    of->tile_layout.height = (int)lround(tile->height);
    double area = tile->width * tile->height / ((double)of->tile_layout.width * of->tile_layout.height);
    of->tile_layout.texel_pitch_mm = of->layout->texel_pitch_mm * sqrt(area);
    of->report->texels_x = of->tile_layout.width;
    of->report->texels_y = of->tile_layout.height;
}

static weft_code check_output(const weft_dataset *dataset, const char *output, weft_error *error)
{
    struct stat a, b;
    if (stat(weft_dataset_path(dataset), &a) == 0 && stat(output, &b) == 0 && a.st_dev == b.st_dev &&
        a.st_ino == b.st_ino)
        return weft_fail(error, WEFT_BAD_USAGE, "'%s' is the dataset itself; the tile would replace it", output);
    return WEFT_OK;
}

weft_code weft_tile_write(weft_dataset *dataset, const char *output, const weft_progress *progress,
                          weft_tile_report *report, weft_error *error)
{
    averaging of = {.layout = weft_dataset_get_layout(dataset), .tile = report->tile, .report = report};
    WEFT_TRY(check_output(dataset, output, error));
    lay_out(&of);
    report->empty_count = 0;
    size_t images = (size_t)of.layout->image_count, row = (size_t)of.tile_layout.width * images;
    size_t sample_bytes = 4 * sizeof *of.sum + 3 * sizeof *of.samples + sizeof *of.mask;
    size_t fit = enough_bytes / (row * sample_bytes);
    int most_rows = fit < 1 ? 1 : fit < (size_t)of.tile_layout.height ? (int)fit : of.tile_layout.height;
    size_t samples = row * (size_t)most_rows;
    of.sum = malloc(3 * samples * sizeof *of.sum);
    of.weight = malloc(samples * sizeof *of.weight);
    of.samples = malloc(3 * samples * sizeof *of.samples);
    of.mask = malloc(samples);
    of.image = calloc(images, sizeof *of.image);
    weft_code code = WEFT_OK;
    if (!of.sum || !of.weight || !of.samples || !of.mask || !of.image)
        code = weft_fail_memory(error, "rows of the tile", samples * sample_bytes);
    if (code == WEFT_OK)
        code = write_tile(&of, dataset, output, most_rows, progress, error);
    free(of.sum);
    free(of.weight);
    free(of.samples);
    free(of.mask);
    free(of.image);
    return code;
}
